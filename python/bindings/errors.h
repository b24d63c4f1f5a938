#pragma once
#include <pybind11/pybind11.h>

#include <string_view>

// Errors in Python's classes, which orchard_geometry/_errors.py defines.
namespace orchard::python {

namespace py = pybind11;

// Sets the error of a class of that module. The names of files in a message may be no UTF-8.
inline void set_error(const char* name, std::string_view message) {
  const py::object error = py::module_::import("orchard_geometry._errors").attr(name);
  PyObject* text = PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "surrogateescape");
  if (text == nullptr) return;
  PyErr_SetObject(error.ptr(), text);
  Py_DECREF(text);
}

}  // namespace orchard::python
