#pragma once

#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "handles.hpp"

// Numbers as numpy arrays that can't be written to.
namespace rollfix::python {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

template <class T>
py::array_t<T> frozen(py::array_t<T> array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A list as an array of this shape, which owns it: nothing is copied.
template <class T>
py::array_t<T> array_of(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* list) { delete static_cast<std::vector<T>*>(list); });
  return frozen(py::array_t<T>(std::move(shape), kept->data(), owner));
}

template <class T>
py::array_t<T> array_of(std::vector<T> values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return array_of(std::move(values), {size});
}

inline py::array_t<double> array_of(const PerFinger<double>& values) {
  return frozen(py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.begin()));
}

inline py::array_t<double> array_of(const PerFinger<Interval>& values) {
  py::array_t<double> array({static_cast<py::ssize_t>(values.size()), py::ssize_t{2}});
  double* out = array.mutable_data();
  for (const Interval& one : values) {
    *out++ = one.lo;
    *out++ = one.hi;
  }
  return frozen(std::move(array));
}

inline py::array_t<double> array_of(const PerFinger<Vec2>& values) {
  py::array_t<double> array({static_cast<py::ssize_t>(values.size()), py::ssize_t{2}});
  double* out = array.mutable_data();
  for (const Vec2& one : values) {
    *out++ = one.x();
    *out++ = one.y();
  }
  return frozen(std::move(array));
}

/// One row for each entry, of `width` numbers that `fill` writes.
template <class Entries, class Fill>
py::array_t<double> rows_of(const Entries& entries, std::size_t width, const Fill& fill) {
  py::array_t<double> array({static_cast<py::ssize_t>(entries.size()), static_cast<py::ssize_t>(width)});
  double* out = array.mutable_data();
  for (const auto& entry : entries) {
    fill(entry, out);
    out += width;
  }
  return frozen(std::move(array));
}

inline py::array_t<double> array_of(const std::vector<Interval>& values) {
  return rows_of(values, 2, [](const Interval& one, double* out) {
    out[0] = one.lo;
    out[1] = one.hi;
  });
}

inline py::array_t<double> array_of(const std::vector<Pose>& poses) {
  return rows_of(poses, 3, [](const Pose& pose, double* out) {
    out[0] = pose.x;
    out[1] = pose.y;
    out[2] = pose.heading;
  });
}

inline py::array_t<double> array_of(const std::vector<Vec2>& points) {
  return rows_of(points, 2, [](const Vec2& point, double* out) {
    out[0] = point.x();
    out[1] = point.y();
  });
}

template <int Size, int Options>
py::array_t<double> array_of(const Eigen::Matrix<double, Size, Size, Options>& matrix) {
  py::array_t<double> array({py::ssize_t{Size}, py::ssize_t{Size}});
  for (int i = 0; i < Size; ++i) {
    for (int j = 0; j < Size; ++j) array.mutable_at(i, j) = matrix(i, j);
  }
  return frozen(std::move(array));
}

inline std::vector<double> list_of(const Numbers& values) { return {values.data(), values.data() + values.size()}; }

}  // namespace rollfix::python
