#pragma once
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Arrays between Python and C++, through the buffer protocol alone: no header of NumPy takes part, so that the modules
// work with every version of it. What changes when the binding library does is in this file.
namespace orchard::python {

namespace py = pybind11;

// The letter that the buffer protocol has for a type.
template <class T>
constexpr const char* format_of() {
  if constexpr (std::is_same_v<T, double>) return "d";
  if constexpr (std::is_same_v<T, float>) return "f";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "B";
  if constexpr (std::is_same_v<T, std::int32_t>) return "i";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "I";
  if constexpr (std::is_same_v<T, std::int64_t>) return "q";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "Q";
}

// An array that C++ owns, for numpy.asarray() to view: it is not copied, not writable, and lives as long as a view of
// it does.
struct Array {
  std::shared_ptr<const void> owner;
  const void* data = nullptr;
  const char* format = "d";
  py::ssize_t item = sizeof(double);
  std::vector<py::ssize_t> shape, strides;  // strides in bytes
};

inline void bind_array(py::module_& module) {
  py::class_<Array>(module, "Array", py::buffer_protocol(), py::module_local(),
                    "An array that C++ owns. numpy.asarray() views it without a copy.")
      .def_buffer([](const Array& array) {
        static const double nothing = 0;  // an empty array needs an address as well
        return py::buffer_info(const_cast<void*>(array.data ? array.data : &nothing), array.item, array.format,
                               static_cast<py::ssize_t>(array.shape.size()), array.shape, array.strides, true);
      });
}

// A view of what `owner` keeps alive: `shape` items that are so many bytes apart.
template <class T>
Array view(std::shared_ptr<const void> owner, const T* data, std::vector<py::ssize_t> shape,
           std::vector<py::ssize_t> strides) {
  return {std::move(owner), data, format_of<T>(), sizeof(T), std::move(shape), std::move(strides)};
}

// How many numbers of type T a row has. The check takes a row that is a number itself for a mistake.
template <class T, class Row>
inline constexpr auto kColumns = static_cast<py::ssize_t>(sizeof(Row) /
                                                          sizeof(T));  // NOLINT(bugprone-sizeof-expression)

// A vector of numbers as (n,), or of rows of numbers (points, triangles) as (n, columns), which the owner keeps alive.
template <class T, class Row>
Array view_rows(std::shared_ptr<const void> owner, const std::vector<Row>& rows) {
  constexpr py::ssize_t columns = kColumns<T, Row>;
  const auto count = static_cast<py::ssize_t>(rows.size());
  const T* data = reinterpret_cast<const T*>(rows.data());
  if constexpr (std::is_same_v<T, Row>) return view(std::move(owner), data, {count}, {sizeof(T)});
  return view(std::move(owner), data, {count, columns}, {sizeof(Row), sizeof(T)});
}

// The same of a vector that is handed over.
template <class T, class Row>
Array own_rows(std::vector<Row> rows) {
  auto owner = std::make_shared<const std::vector<Row>>(std::move(rows));
  return view_rows<T>(owner, *owner);
}
template <class T>
Array own(std::vector<T> values) {
  return own_rows<T, T>(std::move(values));
}

// One field of each of a vector's items, as (n,) or (n, columns): no copy, but strides of a whole item.
template <class T, class Item, class Field>
Array field(const std::shared_ptr<const std::vector<Item>>& items, Field Item::*member) {
  constexpr py::ssize_t columns = kColumns<T, Field>;
  const auto count = static_cast<py::ssize_t>(items->size());
  const T* data = items->empty() ? nullptr : reinterpret_cast<const T*>(&(items->front().*member));
  if constexpr (columns == 1) return view(items, data, {count}, {sizeof(Item)});
  return view(items, data, {count, columns}, {sizeof(Item), sizeof(T)});
}

// A C-contiguous array of Python's that is read in place. Python's side converts and names what is wrong; what is
// refused here would be a mistake of that side.
template <class T>
class Input {
 public:
  Input(const py::buffer& buffer, py::ssize_t columns) : info_(buffer.request()), columns_(columns) {
    const bool rows = columns > 0;
    if (info_.ndim != (rows ? 2 : 1) || (rows && info_.shape[1] != columns) || info_.itemsize != sizeof(T) ||
        !same_format(info_.format))
      throw py::value_error("expected a C-contiguous array of " + std::string(format_of<T>()) + " with " +
                            std::to_string(columns) + " columns");
    py::ssize_t stride = sizeof(T);
    for (py::ssize_t axis = info_.ndim - 1; axis >= 0; --axis) {
      if (info_.shape[static_cast<std::size_t>(axis)] > 1 && info_.strides[static_cast<std::size_t>(axis)] != stride)
        throw py::value_error("expected a C-contiguous array");
      stride *= info_.shape[static_cast<std::size_t>(axis)];
    }
  }

  std::size_t size() const { return static_cast<std::size_t>(info_.shape[0]); }
  const T* row(std::size_t i) const {
    return static_cast<const T*>(info_.ptr) + i * static_cast<std::size_t>(columns_ > 0 ? columns_ : 1);
  }
  const T& operator[](std::size_t i) const { return *row(i); }

  // A copy, row by row; Row is made of numbers of this type.
  template <class Row>
  std::vector<Row> rows() const {
    static_assert(sizeof(Row) % sizeof(T) == 0);
    std::vector<Row> copy(size());
    if (!copy.empty()) std::memcpy(static_cast<void*>(copy.data()), info_.ptr, copy.size() * sizeof(Row));
    return copy;
  }

 private:
  // Native byte order; "l" and "q" are both 64 bits of a signed number here.
  static bool same_format(std::string_view format) {
    if (!format.empty() && (format.front() == '@' || format.front() == '=' || format.front() == '<'))
      format.remove_prefix(1);
    const std::string_view wanted = format_of<T>();
    return format == wanted || (wanted == "q" && format == "l") || (wanted == "Q" && format == "L");
  }

  py::buffer_info info_;
  py::ssize_t columns_;
};

}  // namespace orchard::python
