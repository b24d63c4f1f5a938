#include <gtest/gtest.h>
#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

#include "orchard/geometry/mesh_io.h"
#include "values.h"

// Every array of every view that the program writes: what it may hold, in which unit, and how it says "none".
namespace orchard {
namespace {

namespace fs = std::filesystem;
using test::TestFolder;

constexpr double kScale = 4;  // of the second model: a power of two scales lengths exactly, and nothing else

// What an array holds. Lengths are in mesh units; percent are of the diagonal.
enum class Unit { length, place, angle, percent, ratio, count, direction };
struct Rule {
  Unit unit = Unit::count;
  bool none = false;                // NaN among numbers, -1 among counts
  double max = 1e9;                 // of counts and ratios
  const char* counts_in = nullptr;  // the ending of the file whose points a count is a number of
};

const std::map<std::string, Rule>& rules() {
  static const std::map<std::string, Rule> kRules{
      {"bounding_radius", {Unit::length}},
      {"diagonal", {Unit::length}},
      {"radius", {Unit::length}},
      {"medial_radius", {Unit::length}},
      {"thickness", {.unit = Unit::length, .none = true}},
      {"ball_diameter", {.unit = Unit::length, .none = true}},
      {"gap", {Unit::length}},
      {"length", {Unit::length}},
      {"mean_radius", {Unit::length}},
      {"inaccuracy", {.unit = Unit::length, .none = true}},
      {"error", {.unit = Unit::length, .none = true}},
      {"separation_bound", {.unit = Unit::length, .none = true}},
      {"horn_radius", {Unit::length}},
      {"hypertrapezoid_half", {Unit::length}},
      {"contact_angle", {.unit = Unit::angle, .none = true}},
      {"coverage", {Unit::percent}},
      {"protrusion", {Unit::percent}},
      {"radius_error", {Unit::percent}},
      {"value", {Unit::percent}},
      {"centredness", {.unit = Unit::ratio, .none = true}},
      {"repair_pass", {.unit = Unit::ratio, .none = true}},
      {"samples", {Unit::place}},
      {"outward", {Unit::direction}},
      {"origin", {.max = 2}},
      {"measure", {.max = 2}},
      {"kind", {.max = 2}},
      {"answer", {.max = 3}},
      {"added", {.max = 1}},
      {"has_faces", {.max = 1}},
      {"trunk", {.max = 1}},
      {"topology_face", {.max = 1}},
      {"carried", {.max = 1}},
      {"at_box", {.max = 1}},
      {"forming_points", {.none = true, .counts_in = "-medial-contacts.vtp"}},
      {"point_a", {.none = true, .counts_in = "-medial-contacts.vtp"}},
      {"point_b", {.none = true, .counts_in = "-medial-contacts.vtp"}},
      {"vertex", {.counts_in = "-medial-vertices.vtp"}},
      {"contact_ball", {.counts_in = "-medial-vertices.vtp"}},
      {"contact_sample", {}},
      {"sample_ball", {.none = true, .counts_in = "-medial-vertices.vtp"}},
      {"segment", {.none = true}},
      {"thin_region", {.none = true}},
      {"structure", {}},
      {"structure_kind", {.max = 4}},
      {"parent", {.none = true}},
      {"branch", {.none = true}},
      {"body", {.none = true}},
      {"level", {.none = true, .max = 20}},
      {"work", {.none = true}}};
  return kRules;
}

const std::vector<std::string>& plain_counts() {
  static const std::vector<std::string> kNames{"cluster", "triangle", "component", "valence", "forming_count", "number",
                                               "from",    "to",       "node",      "point",   "faces"};
  return kNames;
}

template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const fs::path& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << file;
  return vtkDataSet::SafeDownCast(reader->GetOutputAsDataSet());
}

vtkSmartPointer<vtkDataSet> read_data_set(const fs::path& file) {
  return file.extension() == ".vtu" ? read_with<vtkXMLUnstructuredGridReader>(file)
                                    : read_with<vtkXMLPolyDataReader>(file);
}

using Views = std::map<std::string, vtkSmartPointer<vtkDataSet>>;  // by the names of the files

// All views of all commands, of a model that is `scale` times as large.
Views views_of(const TestFolder& folder, double scale) {
  const fs::path where = folder / std::to_string(scale);
  fs::create_directories(where);
  write_obj(where / "l.obj", test::transformed(test::l_shape(), scale, Vector::Zero()));
  const auto run = [&](const std::string& words) {
    const std::string command = std::string("cd '") + where.string() + "' && '" + ORCHARD_PROGRAM + "' " + words;
    EXPECT_EQ(std::system(command.c_str()), 0) << words;
  };
  run("build l.obj -o out --samples 150 --depth 2 --quiet");
  run("medial l.obj -o out --samples 150 --report --quality-samples 200 --vertices 30 --light 40 --quiet");
  run("spheres l.obj -o out --spheres 8 --quiet");
  run("thickness l.obj -o out --samples 100 --below " + std::to_string(0.9 * scale) + " --quiet");
  run("sample l.obj -o out --samples 150 --quiet");
  run("voronoi l.obj -o out --samples 150 --quiet");
  if (scale == 1) run("simulate box --frames 2 -o out --quiet");  // its ship has a size of its own
  Views views;
  for (const auto& entry : fs::directory_iterator(where / "out")) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".vtp" || extension == ".vtu")
      views[entry.path().filename().string()] = read_data_set(entry.path());
  }
  return views;
}

// The numbers of an array, component by component.
std::vector<double> numbers(vtkDataArray* array) {
  std::vector<double> all;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    for (int k = 0; k < array->GetNumberOfComponents(); ++k) all.push_back(array->GetComponent(i, k));
  return all;
}

Rule rule_of(const std::string& name) {
  const auto& plain = plain_counts();
  if (std::find(plain.begin(), plain.end(), name) != plain.end()) return {};
  const auto rule = rules().find(name);
  EXPECT_NE(rule, rules().end()) << "there is no rule for the array " << name;
  return rule == rules().end() ? Rule{} : rule->second;
}

double max_of(const Rule& rule, double diagonal, const Views& views) {
  switch (rule.unit) {
    case Unit::length:
    case Unit::place:
      return 100 * diagonal;  // the lines of a structure graph wind
    case Unit::angle:
      return 180 + 1e-9;
    case Unit::percent:
      return 100;
    case Unit::direction:
      return 1 + 1e-9;
    case Unit::ratio:
      return 10;
    case Unit::count:
      break;
  }
  if (rule.counts_in == nullptr) return rule.max;
  for (const auto& [name, view] : views)
    if (name.ends_with(rule.counts_in)) return static_cast<double>(view->GetNumberOfPoints()) - 1;
  return -1;
}

void expect_by_rule(vtkDataArray* array, const Rule& rule, double diagonal, const Views& views) {
  const bool counts = rule.unit == Unit::count;
  EXPECT_EQ(array->GetDataTypeAsString() == std::string("double"), !counts);
  const double max = max_of(rule, diagonal, views);
  const bool either_sign = rule.unit == Unit::direction || rule.unit == Unit::place;
  const double min = either_sign ? -max : counts && rule.none ? -1 : 0;
  for (const double number : numbers(array)) {
    if (std::isnan(number)) {
      ASSERT_TRUE(rule.none && !counts) << "no value, where there must be one";
      continue;
    }
    ASSERT_GE(number, min);
    ASSERT_LE(number, max);
  }
}

template <class Visit>  // (name of file, kind of data, its arrays)
void visit_all(const Views& views, const Visit& visit) {
  for (const auto& [file, view] : views) {
    visit(file, "points", view->GetPointData());
    visit(file, "cells", view->GetCellData());
    visit(file, "field", view->GetFieldData());
  }
}

void expect_point_data_alone(const Views& views, const char* name) {
  ASSERT_TRUE(views.contains(name)) << name;
  EXPECT_EQ(views.at(name)->GetCellData()->GetNumberOfArrays(), 0) << name;
  EXPECT_GE(views.at(name)->GetPointData()->GetNumberOfArrays(), 2) << name;
}

void expect_provenance(const std::string& name, vtkDataSet* view) {
  auto* text = vtkStringArray::SafeDownCast(view->GetFieldData()->GetAbstractArray("provenance"));
  ASSERT_NE(text, nullptr) << name;
  ASSERT_EQ(text->GetNumberOfValues(), 1) << name;
  EXPECT_TRUE(text->GetValue(0).starts_with("orchard {\"command_line\":\"orchard ")) << name;
  EXPECT_TRUE(text->GetValue(0).ends_with("}")) << name;
}

// "NAME [UNIT]: MEANING" of each array, by name.
std::map<std::string, std::string> descriptions_of(vtkDataSet* view) {
  std::map<std::string, std::string> lines;
  auto* texts = vtkStringArray::SafeDownCast(view->GetFieldData()->GetAbstractArray("descriptions"));
  for (vtkIdType i = 0; texts != nullptr && i < texts->GetNumberOfValues(); ++i) {
    const std::string line = texts->GetValue(i);
    lines[line.substr(0, line.find_first_of(" :"))] = line;
  }
  return lines;
}

// What data.md calls the unit of a rule.
std::string named_unit(Unit unit) {
  switch (unit) {
    case Unit::length:
    case Unit::place:
      return " [mesh units]: ";
    case Unit::angle:
      return " [degrees]: ";
    case Unit::percent:
      return " [% of the diagonal]: ";
    default:
      return ": ";
  }
}

TEST(ViewArrays, HoldWhatTheirRuleSays) {
  const TestFolder folder;
  const Views views = views_of(folder, 1);
  EXPECT_GT(views.size(), 20u);
  std::size_t arrays = 0;
  visit_all(views, [&](const std::string& file, const char* kind, vtkFieldData* data) {
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
      vtkDataArray* array = data->GetArray(i);
      if (array == nullptr) continue;  // texts
      SCOPED_TRACE(file + ", " + kind + ", " + array->GetName());
      expect_by_rule(array, rule_of(array->GetName()), 10, views);
      ++arrays;
    }
  });
  EXPECT_GT(arrays, 100u);
  for (const char* name : {"l-build-points.vtp", "l-medial-points.vtp", "l-sample-points.vtp"})
    expect_point_data_alone(views, name);
  for (const auto& [name, view] : views) expect_provenance(name, view);
}

TEST(ViewArrays, AreDescribedInTheirFile) {
  const TestFolder folder;
  const Views views = views_of(folder, 1);
  std::size_t described = 0;
  visit_all(views, [&](const std::string& file, const char* kind, vtkFieldData* data) {
    const std::map<std::string, std::string> lines = descriptions_of(views.at(file));
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
      const std::string name = data->GetAbstractArray(i)->GetName();
      if (name == "provenance" || name == "descriptions") continue;
      SCOPED_TRACE(file + ", " + kind + ", " + name);
      ASSERT_TRUE(lines.contains(name)) << "docs/reference/arrays.json does not list it";
      EXPECT_NE(lines.at(name).find(named_unit(rule_of(name).unit)), std::string::npos) << lines.at(name);
      ++described;
    }
  });
  EXPECT_GT(described, 150u);
}

TEST(ViewArrays, ScaleWithTheModelIfTheyAreLengthsAndNotOtherwise) {
  const TestFolder folder;
  const Views small = views_of(folder, 1), large = views_of(folder, kScale);
  visit_all(large, [&](const std::string& file, const char* kind, vtkFieldData* data) {
    ASSERT_TRUE(small.contains(file)) << file;
    vtkDataSet* other = small.at(file);
    vtkFieldData* others = kind == std::string("points")  ? static_cast<vtkFieldData*>(other->GetPointData())
                           : kind == std::string("cells") ? static_cast<vtkFieldData*>(other->GetCellData())
                                                          : other->GetFieldData();
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
      if (data->GetArray(i) == nullptr) continue;
      const std::string name = data->GetArray(i)->GetName();
      SCOPED_TRACE(file + ", " + kind + ", " + name);
      const Unit unit = rule_of(name).unit;
      const double factor = unit == Unit::length || unit == Unit::place ? kScale : 1;
      const std::vector<double> values = numbers(data->GetArray(i)), before = numbers(others->GetArray(name.c_str()));
      ASSERT_EQ(values.size(), before.size());
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (std::isnan(before[k])) {
          ASSERT_TRUE(std::isnan(values[k]));
        } else {
          ASSERT_NEAR(values[k], factor * before[k], 1e-9 * std::max(1.0, std::abs(values[k])));
        }
      }
    }
  });
}

}  // namespace
}  // namespace orchard
