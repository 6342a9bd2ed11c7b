#pragma once

#include <optional>
#include <string>
#include <vector>

#include "handles.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/reading.hpp"

// Fingers and noise as the Python classes of these names hold them.
namespace rollfix::python {

/// A number: a disk's radius. "jaw". A PartHandle: an outline.
inline Finger finger_from(const py::handle& given) {
  if (py::isinstance<py::str>(given)) return jaw();
  if (py::isinstance<PartHandle>(given)) return Finger::outlined(given.cast<const PartHandle&>().part());
  const Finger finger = disk(given.cast<double>());
  require_valid(finger);
  return finger;
}

inline std::vector<Finger> fingers_from(const py::iterable& given) {
  std::vector<Finger> fingers;
  for (const py::handle one : given) fingers.push_back(finger_from(one));
  return fingers;
}

inline py::object finger_to(const Finger& finger) {
  if (finger.is_disk()) return py::float_(finger.disk()->radius);
  if (finger.is_jaw()) return py::str("jaw");
  return py::cast(PartHandle(*finger.outline()));
}

inline py::tuple fingers_to(const std::vector<Finger>& fingers) {
  py::list list;
  for (const Finger& finger : fingers) list.append(finger_to(finger));
  return py::tuple(list);
}

/// The standard deviations by their names.
inline Noise noise_from(const py::dict& given) {
  Noise noise;
  for (const NoiseKind& kind : kNoiseKinds) {
    if (given.contains(kind.name)) noise.*kind.sd = given[kind.name].cast<double>();
  }
  require_valid(noise);
  return noise;
}

inline std::optional<Noise> noise_from_optional(const py::object& given) {
  if (given.is_none()) return std::nullopt;
  return noise_from(given.cast<py::dict>());
}

inline py::dict noise_to(const Noise& noise) {
  py::dict result;
  for (const NoiseKind& kind : kNoiseKinds) result[kind.name] = noise.*kind.sd;
  return result;
}

}  // namespace rollfix::python
