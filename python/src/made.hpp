#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

// An object that `__new__` made and nobody gave a value: pybind11 would hand out memory that nothing was written to.
namespace rollfix::python {

/// Whether Python has a class of this type. To be said before the type is first met.
template <class T>
inline constexpr bool kIsPythonClass = false;

/// Throws TypeError: an object of the class without its value.
template <class T>
void require_made(pybind11::handle object) {
  if (!object || !pybind11::isinstance<T>(object)) return;
  auto* const instance = reinterpret_cast<pybind11::detail::instance*>(object.ptr());
  for (const auto& base : pybind11::detail::values_and_holders(instance)) {
    if (base.value_ptr() != nullptr) continue;
    const std::string name = pybind11::type::of(object).attr("__name__").cast<std::string>();
    throw pybind11::type_error(name + ": has no value: it was made by __new__ alone");
  }
}

/// What pickle and copy are told, for every protocol: by those below 2 the default would make an object of pybind11's
/// base class, which ends the interpreter.
inline pybind11::tuple reduced(const pybind11::object& object) {
  const pybind11::type type = pybind11::type::of(object);
  if (!pybind11::bool_(type.attr("__dict__").attr("__contains__")("__setstate__"))) {
    throw pybind11::type_error("cannot pickle '" + type.attr("__name__").cast<std::string>() + "' object");
  }
  const auto make = pybind11::module_::import("copyreg").attr("__newobj__");
  return pybind11::make_tuple(make, pybind11::make_tuple(type), object.attr("__getstate__")());
}

/// Of all classes of a module, once they are there.
inline void let_be_pickled(pybind11::module_& module) {
  for (const auto& [name, value] : module.attr("__dict__").cast<pybind11::dict>()) {
    if (!pybind11::isinstance<pybind11::type>(value) ||
        pybind11::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr())) == nullptr)
      continue;
    value.attr("__reduce__") = pybind11::cpp_function(&reduced, pybind11::is_method(value));
  }
}

}  // namespace rollfix::python

namespace pybind11::detail {

template <class T>
class type_caster<T, std::enable_if_t<rollfix::python::kIsPythonClass<T>>> : public type_caster_base<T> {
 public:
  bool load(handle source, bool convert) {
    rollfix::python::require_made<T>(source);
    return type_caster_base<T>::load(source, convert);
  }
};

}  // namespace pybind11::detail
