// Records queries and what the native run-time answers: orchard_web_recorder OUTPUT COUNT TREE.orchard..
// web/test/replay.mjs asks the WebAssembly module the same and wants the same bits.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "record.h"

namespace orchard::web {

Row& Row::add(const orchard_verdict& v) {
  add_all(v.answer, v.separation_bound, v.lower_bound).add(v.contact_center, 3);
  add_all(v.contact_radius).add(v.contact_normal, 3);
  return add_all(v.triangle_a, v.triangle_b, v.level, v.finished, v.refused, v.work);
}

void Recording::add(Kind kind, const Row& arguments, const Row& answers) {
  numbers_.push_back(static_cast<double>(kind));
  for (const Row* row : {&arguments, &answers}) {
    numbers_.push_back(static_cast<double>(row->numbers.size()));
    numbers_.insert(numbers_.end(), row->numbers.begin(), row->numbers.end());
  }
  ++count_;
}

bool Recording::write(const char* path) const {
  std::FILE* const file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  const double count = static_cast<double>(count_);
  bool done = std::fwrite(&count, sizeof count, 1, file) == 1;
  done = std::fwrite(numbers_.data(), sizeof(double), numbers_.size(), file) == numbers_.size() && done;
  return std::fclose(file) == 0 && done;
}

namespace {

constexpr orchard_budget kNoLimit{ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT};

class Recorder {
 public:
  Recorder(const std::vector<orchard_tree*>& trees, Recording& recording)
      : trees_(trees), recording_(recording), workspace_(orchard_workspace_new()) {
    for (orchard_tree* a : trees_)
      for (orchard_tree* b : trees_) pairs_.push_back(orchard_pair_new(a, b));
  }
  ~Recorder() {
    for (orchard_pair* pair : pairs_) orchard_pair_free(pair);
    orchard_workspace_free(workspace_);
  }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void record(std::size_t count) {
    // Of a thousand queries so many are of each kind, and the others collide(): the dear ones are few.
    const std::array<void (Recorder::*)(), 10> asks{
        &Recorder::pose,          &Recorder::levels,         &Recorder::distance, &Recorder::collide_again,
        &Recorder::nearest_point, &Recorder::cast_ray,       &Recorder::inside,   &Recorder::closer_than,
        &Recorder::contacts,      &Recorder::signed_distance};
    const std::array<std::size_t, 10> shares{40, 80, 100, 60, 50, 50, 30, 50, 2, 2};
    record_broad_phase(recording_, draws_);
    record_detector(recording_, draws_, trees_);
    batch(1000);
    while (recording_.count() < count) {
      std::size_t draw = draws_.below(1000), kind = 0;
      while (kind < asks.size() && draw >= shares[kind]) draw -= shares[kind++];
      kind < asks.size() ? (this->*asks[kind])() : collide();
    }
  }

 private:
  // Two bodies about where they touch: as far apart as the sum of the radii, or less.
  struct Question {
    std::size_t a, b;
    orchard_pose poses[2];
  };
  std::array<double, 3> place(double within) {
    return {draws_.uniform(-within, within), draws_.uniform(-within, within), draws_.uniform(-within, within)};
  }
  orchard_pose pose_within(double within) {
    const std::array<double, 4> turn{draws_.uniform(-1, 1), draws_.uniform(-1, 1), draws_.uniform(-1, 1),
                                     draws_.uniform(0.1, 1)};
    orchard_pose pose = orchard_identity();
    orchard_pose_from_quaternion(turn.data(), place(within).data(), &pose);
    if (draws_.below(4) == 0) pose.scale = draws_.uniform(0.5, 2);
    return pose;
  }
  Question question() {
    Question q{draws_.below(trees_.size()), draws_.below(trees_.size()), {}};
    const double reach = orchard_tree_bounding_radius(trees_[q.a]) + orchard_tree_bounding_radius(trees_[q.b]);
    q.poses[0] = pose_within(0.1 * reach);
    q.poses[1] = pose_within(0.8 * reach);
    return q;
  }
  Row arguments(const Question& q) const {
    Row row;
    return row.add_all(q.a, q.b).add(q.poses[0]).add(q.poses[1]);
  }
  orchard_pair* pair(const Question& q) const { return pairs_[q.a * trees_.size() + q.b]; }

  void pose() {
    const std::array<double, 4> turn{draws_.uniform(-1, 1), draws_.uniform(-1, 1), draws_.uniform(-1, 1), 0.5};
    const std::array<double, 3> to = place(10);
    orchard_pose made = orchard_identity();
    orchard_pose_from_quaternion(turn.data(), to.data(), &made);
    Row asked, answers;
    recording_.add(Kind::pose, asked.add(turn.data(), 4).add(to.data(), 3), answers.add(made));
  }
  void collide() {
    const Question q = question();
    const bool limited = draws_.below(5) == 0;
    const std::uint64_t tests = limited ? draws_.below(300) : ORCHARD_NO_LIMIT;
    Row answers;
    answers.add(orchard_collide(pair(q), &q.poses[0], &q.poses[1], {tests, ORCHARD_NO_LIMIT}));
    recording_.add(Kind::collide, arguments(q).add_all(limited ? static_cast<double>(tests) : INFINITY), answers);
  }
  void levels() {
    const Question q = question();
    Row answers;
    orchard_verdict verdict = orchard_start(pair(q), &q.poses[0], &q.poses[1]);
    answers.add(verdict);
    while (!verdict.finished) {
      verdict = orchard_refine(pair(q), kNoLimit);
      answers.add(verdict);
    }
    recording_.add(Kind::levels, arguments(q), answers);
  }
  void distance() {
    const Question q = question();
    const double tolerance = draws_.below(2) == 0 ? 0 : 0.1;
    const orchard_distance d = orchard_measure(pair(q), &q.poses[0], &q.poses[1], tolerance);
    Row answers;
    answers.add_all(d.lower, d.upper).add(d.on_a, 3).add(d.on_b, 3).add_all(d.triangle_a, d.triangle_b);
    recording_.add(Kind::distance, arguments(q).add_all(tolerance), answers);
  }
  void collide_again() {  // the same pair, moved a little, three times
    Question q = question();
    Row asked = arguments(q), answers;
    for (int i = 0; i < 3; ++i) {
      q.poses[1].translation[0] += 0.01;
      answers.add(orchard_collide_again(pair(q), &q.poses[0], &q.poses[1]));
    }
    recording_.add(Kind::collide_again, asked, answers);
  }
  void nearest_point() {
    const Question q = question();
    const std::array<double, 3> point = place(3);
    double distance = 0;
    std::array<double, 3> nearest{}, normal{};
    std::uint32_t triangle = 0;
    const int found = orchard_signed_nearest_point(trees_[q.a], &q.poses[0], point.data(), INFINITY, &distance,
                                                   nearest.data(), normal.data(), &triangle);
    Row asked, answers;
    asked.add_all(q.a).add(q.poses[0]).add(point.data(), 3);
    answers.add_all(found, distance).add(nearest.data(), 3).add(normal.data(), 3);
    recording_.add(Kind::nearest_point, asked, answers.add_all(triangle));
  }
  void cast_ray() {
    const Question q = question();
    const std::array<double, 3> origin = place(6), to = place(1);
    double along = 0;
    const int found = orchard_cast_ray(trees_[q.a], &q.poses[0], origin.data(), to.data(), INFINITY, &along);
    Row asked, answers;
    asked.add_all(q.a).add(q.poses[0]).add(origin.data(), 3).add(to.data(), 3);
    recording_.add(Kind::cast_ray, asked, answers.add_all(found, along));
  }
  void inside() {
    const Question q = question();
    const std::array<double, 3> p = place(2), end = place(2);
    const int contains = orchard_contains(trees_[q.a], &q.poses[0], p.data());
    const int touches = orchard_capsule_touches(trees_[q.a], &q.poses[0], p.data(), end.data(), 0.1);
    Row asked, answers;
    asked.add_all(q.a).add(q.poses[0]).add(p.data(), 3).add(end.data(), 3).add_all(0.1);
    recording_.add(Kind::inside, asked, answers.add_all(contains, touches));
  }
  void closer_than() {
    const Question q = question();
    const double margin = draws_.uniform(0, 1);
    const int closer =
        orchard_closer_than(workspace_, trees_[q.a], &q.poses[0], trees_[q.b], &q.poses[1], margin, nullptr);
    Row answers;
    recording_.add(Kind::closer_than, arguments(q).add_all(margin), answers.add_all(closer));
  }
  void contacts() {
    const Question q = question();
    const orchard_manifold m = orchard_contacts(workspace_, trees_[q.a], &q.poses[0], trees_[q.b], &q.poses[1], 0.05);
    Row answers;
    answers.add_all(m.answer, m.count).add(m.normal, 3);
    answers.add_all(m.depth, m.error, m.complete);
    for (std::size_t i = 0; i < m.count; ++i) {
      const orchard_contact_point& point = m.points[i];
      answers.add(point.place, 3).add_all(point.triangle_a, point.triangle_b, point.depth);
    }
    recording_.add(Kind::contacts, arguments(q).add_all(0.05), answers);
  }
  void signed_distance() {
    const Question q = question();
    const orchard_signed_distance d =
        orchard_measure_signed(workspace_, trees_[q.a], &q.poses[0], trees_[q.b], &q.poses[1], 0);
    Row answers;
    answers.add_all(d.lower, d.upper).add(d.on_a, 3).add(d.on_b, 3).add(d.normal, 3);
    recording_.add(Kind::signed_distance, arguments(q), answers);
  }
  // Each pair of a batch as if it were asked alone; the arguments are rows of two trees and two poses.
  void batch(std::size_t count) {
    Row asked, answers;
    for (std::size_t i = 0; i < count; ++i) {
      const Question q = question();
      const Row row = arguments(q);
      asked.add(row.numbers.data(), row.numbers.size());
      answers.add(orchard_collide(pair(q), &q.poses[0], &q.poses[1], kNoLimit));
    }
    recording_.add(Kind::batch, asked, answers);
  }

  const std::vector<orchard_tree*>& trees_;
  Recording& recording_;
  orchard_workspace* workspace_;
  std::vector<orchard_pair*> pairs_;
  Draws draws_{69};
};

int run(int argc, char** argv) {
  const char* const usage = "Usage: orchard_web_recorder OUTPUT COUNT TREE.orchard..\n";
  const long count = argc > 3 ? std::strtol(argv[2], nullptr, 10) : 0;
  if (count <= 0) return std::fputs(usage, stderr), 2;
  std::vector<orchard_tree*> trees;
  for (int i = 3; i < argc; ++i) {
    const char* error = nullptr;
    trees.push_back(orchard_tree_read(argv[i], &error));
    if (trees.back() == nullptr) return std::fprintf(stderr, "%s: %s\n", argv[i], error), 2;
  }
  Recording recording;
  Recorder(trees, recording).record(static_cast<std::size_t>(count));
  for (orchard_tree* tree : trees) orchard_tree_close(tree);
  if (!recording.write(argv[1])) return std::fprintf(stderr, "%s cannot be written\n", argv[1]), 1;
  std::printf("%zu queries and their answers: %s\n", recording.count(), argv[1]);
  return 0;
}

}  // namespace
}  // namespace orchard::web

int main(int argc, char** argv) { return orchard::web::run(argc, argv); }
