#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rollfix/outline/outline.hpp"

namespace rollfix {

/// What a parameter of a gallery shape may be.
enum class ParameterKind {
  length,  // a number above 0, within what squares and cubes of it can hold
  number,  // a number from least to most
  whole,   // a whole number from least to most
  text
};

struct GalleryParameter {
  std::string name;
  std::string default_value;  // as a user would write it
  std::string meaning;
  ParameterKind kind = ParameterKind::length;
  double least = 0;
  double most = 0;
};

/// The values that a parameter takes, in words: "a whole number from 3 to 1000".
std::string allowed_values(const GalleryParameter& parameter);

/// A named shape. Everything that help, documentation and error messages say of it comes from here.
struct GalleryShape {
  std::string name;
  std::string formula;
  std::string start;   // where s = 0 is
  std::string remark;  // what is special about it, above all what makes it hard
  bool closed = true;
  bool smooth = true;  // false: it has corners
  std::vector<GalleryParameter> parameters;
};

const std::vector<GalleryShape>& gallery_shapes();

/// Parameters as the user wrote them: name and value.
using ParameterList = std::vector<std::pair<std::string, std::string>>;

/// The shape with these parameters, the rest at their defaults. Counter-clockwise when closed, s = 0 where the
/// usual formula's parameter is 0, no velocity of 0 anywhere. Named "gallery:ellipse,a=2,b=1", which gives it again.
/// Throws InputError: unknown shape or parameter (with the valid ones and the nearest), a parameter given
/// twice, or a value that is not allowed.
Outline gallery(const std::string& shape, const ParameterList& parameters);

/// The same from one text: "ellipse", "ellipse,a=2,b=1", with or without "gallery:" before it.
Outline gallery(const std::string& specification);

}  // namespace rollfix
