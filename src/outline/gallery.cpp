#include "rollfix/outline.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "outline/shapes/shapes.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

// The table of named shapes, and the check of their parameters.
// Notation:
//   shape           a row of the table: name, formula, parameters, what makes its curves: Entry
//   parameter       name, default, meaning and allowed values: GalleryParameter; a user's values: Parameters
// Follows docs/gallery.md, which is made of this table; the curves themselves are in shapes/.
// Idea: each shape is described once, and help, documentation and messages come from there. Values stay texts until a
// shape asks for a number, so that an outline's name repeats what the user wrote.
namespace rollfix {
namespace {

/// The parameter's place in the shape's list. Throws InputError with the names that there are, and the nearest.
std::size_t index_of(const GalleryShape& shape, const std::string& name) {
  // Collected for the message, should the name not be found.
  std::vector<std::string> names;
  for (std::size_t i = 0; i < shape.parameters.size(); ++i) {
    if (shape.parameters[i].name == name) return i;
    names.push_back(shape.parameters[i].name);
  }
  throw InputError(
      fmt::format("gallery shape '{}' has no parameter '{}'; {}", shape.name, name, known_names(name, names)));
}

/// Whether the text is a value that this kind of parameter takes.
bool is_allowed(const GalleryParameter& parameter, const std::string& text) {
  if (parameter.kind == ParameterKind::text) return !text.empty();
  // The whole text must be a number: "2mm" is none.
  const std::optional<double> value = parse_number(text);
  if (!value || !std::isfinite(*value)) return false;
  // Lengths have limits of their own, beyond which cubes of them overflow.
  if (parameter.kind == ParameterKind::length) return *value >= kLeastLength && *value <= kMostLength;
  if (parameter.kind == ParameterKind::whole && *value != std::floor(*value)) return false;
  // Both limits are allowed.
  return *value >= parameter.least && *value <= parameter.most;
}

/// In words; kMostLength is as good as no limit.
std::string allowed_numbers(const GalleryParameter& parameter) {
  if (parameter.most < kMostLength) return fmt::format("a number from {} to {}", parameter.least, parameter.most);
  return parameter.least > -kMostLength ? fmt::format("a number of at least {}", parameter.least) : "a number";
}

/// For an error message: what is allowed, and the limits of all lengths where those are what the value is beyond.
std::string expected_values(const GalleryParameter& parameter, const std::string& text) {
  const double size = std::abs(parse_number(text).value_or(0));
  const bool is_length = parameter.kind == ParameterKind::length;
  // Only then are the limits of lengths worth a word.
  const bool is_beyond = size > kMostLength || (is_length && size > 0 && size < kLeastLength);
  return allowed_values(parameter) + (is_beyond ? fmt::format(" ({} to {})", kLeastLength, kMostLength) : "");
}

}  // namespace

/// As it stands in the help and in docs/gallery.md.
std::string allowed_values(const GalleryParameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::length:
      return "a number above 0";
    case ParameterKind::number:
      return allowed_numbers(parameter);
    case ParameterKind::whole:
      return fmt::format("a whole number from {} to {}", parameter.least, parameter.most);
    // A text's meaning says what it may be.
    case ParameterKind::text:
      break;
  }
  return parameter.meaning;
}

/// Starts with the defaults and replaces what is given.
Parameters::Parameters(const GalleryShape& shape, const ParameterList& given) : shape_(shape) {
  for (const GalleryParameter& parameter : shape.parameters) values_.push_back(parameter.default_value);
  std::vector<bool> is_given(values_.size(), false);
  // Each must be a parameter of the shape, given once, with a value that it takes.
  for (const auto& [name, value] : given) {
    const std::size_t i = index_of(shape, name);
    const GalleryParameter& parameter = shape.parameters[i];
    if (is_given[i]) {
      throw InputError(fmt::format("gallery shape '{}': parameter {} is given twice, as '{}' and '{}'", shape.name,
                                   name, values_[i], value));
    }
    if (!is_allowed(parameter, value)) {
      throw InputError(fmt::format("gallery shape '{}': parameter {} = '{}', expected {}", shape.name, name, value,
                                   expected_values(parameter, value)));
    }
    values_[i] = value;
    is_given[i] = true;
  }
}

/// Checked in the constructor: the text is a number.
double Parameters::number(const std::string& name) const { return *parse_number(text(name)); }

/// As given, or the default; the name must be one of the shape's.
const std::string& Parameters::text(const std::string& name) const { return values_[index_of(shape_, name)]; }

/// The message lists all values, defaults too: the conflict may be with one that the user did not write.
void Parameters::refuse(const std::string& reason) const {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    settings.push_back(fmt::format("{} = {}", shape_.parameters[i].name, values_[i]));
  }
  throw InputError(fmt::format("gallery shape '{}' with {}: {}", shape_.name, fmt::join(settings, ", "), reason));
}

namespace {

/// Makes a shape's curves of its parameters.
using Build = shapes::Curves (*)(const Parameters&);

/// A row of the table.
struct Entry {
  GalleryShape shape;
  Build build;
};

/// Rows of a shape's list of parameters, by kind: name, default, meaning, and of numbers the least and the most
/// allowed.
GalleryParameter length(const char* name, const char* value, const char* meaning) {
  return {name, value, meaning, ParameterKind::length, 0, 0};
}

GalleryParameter number(const char* name, const char* value, const char* meaning, double least, double most) {
  return {name, value, meaning, ParameterKind::number, least, most};
}

GalleryParameter whole(const char* name, const char* value, const char* meaning, double least, double most) {
  return {name, value, meaning, ParameterKind::whole, least, most};
}

GalleryParameter text(const char* name, const char* value, const char* meaning) {
  return {name, value, meaning, ParameterKind::text, 0, 0};
}

// Names for the fields of a row: ends, then corners.
constexpr bool kClosed = true;
constexpr bool kOpen = false;
constexpr bool kSmooth = true;
constexpr bool kCorners = false;
constexpr double kMostSeed = 9007199254740992;  // 2^53: every whole number up to it is a double

/// Each row: name, formula, where s = 0 is, what is special, closed or open, smooth or with corners, parameters, and
/// the function that makes its curves. First those by a formula around a centre.
std::vector<Entry> round_shapes() {
  return {
      {{"circle",
        "x = r cos u, y = r sin u",
        "(r, 0)",
        "every place fits every roll that fits at all",
        kClosed,
        kSmooth,
        {length("r", "1", "radius")}},
       shapes::circle},
      {{"ellipse",
        "x = a cos u, y = b sin u",
        "(a, 0)",
        "two-fold: each place has an opposite one; close to a circle (a = b) it is ill-conditioned",
        kClosed,
        kSmooth,
        {length("a", "2", "half axis along x"), length("b", "1", "half axis along y")}},
       shapes::ellipse},
      {{"superellipse",
        "|x/a|^n + |y/b|^n = 1",
        "(a, 0)",
        "for n > 2 the curvature is 0 at the four points on the axes, without a change of sign; where n is not even "
        "its derivatives break there",
        kClosed,
        kSmooth,
        {length("a", "1.5", "half axis along x"), length("b", "1", "half axis along y"),
         number("n", "4", "exponent, 2 or at least 3", 2, 100)}},
       shapes::superellipse},
      {{"limacon",
        "r = a + b cos u",
        "(a + b, 0)",
        "convex for a >= 2|b|, dimpled below, and for a < |b| it crosses itself; a = |b| has a cusp and is refused",
        kClosed,
        kSmooth,
        {length("a", "1.5", "mean radius"), number("b", "1", "how far it is off centre", -kMostLength, kMostLength)}},
       shapes::limacon},
      {{"cam",
        "r = base + lift ((1 + cos u)/2)^2",
        "(base + lift, 0), the top of the lift",
        "symmetric about the x axis, almost round opposite to the lift",
        kClosed,
        kSmooth,
        {length("base", "1", "radius of the base circle"),
         number("lift", "0.5", "height of the lift above it", 0, kMostLength)}},
       shapes::cam},
      {{"gear",
        "radius r + depth cos(teeth u) at the angle u",
        "(r + depth, 0), the top of a tooth",
        "as many-fold as it has teeth",
        kClosed,
        kSmooth,
        {whole("teeth", "12", "number of teeth", 1, 1000), length("r", "1", "mean radius"),
         number("depth", "0.1", "half the height of a tooth", 0, kMostLength)}},
       shapes::gear},
  };
}

/// Closed ones drawn of pieces or through points.
std::vector<Entry> drawn_shapes() {
  return {
      {{"spline",
        "C2 periodic cubic spline in chord length through n points at equal angles, with radii "
        "1 + wobble * uniform(-1, 1)",
        "the first point, on the x axis",
        "the curvature's derivative jumps at every point; uniform(-1, 1) is 2 k/2^53 - 1 with k the top 53 bits of "
        "std::mt19937_64, one for each point in order",
        kClosed,
        kSmooth,
        {whole("n", "10", "number of points", 3, 100000), whole("seed", "7", "of the generator", 0, kMostSeed),
         number("wobble", "0.25", "how far the radii stray from 1", 0, 0.99)}},
       shapes::spline},
      {{"naca",
        "4-digit section with the closed trailing edge (-0.1036 x^4): camber, its place, thickness",
        "the trailing edge (chord, 0), then over the top",
        "a sharp corner at the trailing edge; with camber also a very slight one above and below its highest place, "
        "where the formula's own tangent jumps; the curvature's derivative jumps at the nose",
        kClosed,
        kCorners,
        {text("digits", "2412", "the four digits, such as 0012 or 2412"), length("chord", "1", "length")}},
       shapes::naca},
      {{"reuleaux",
        "three arcs of radius width around each other's ends",
        "the corner (width/sqrt 3, 0)",
        "every place on an arc fits as well as any other",
        kClosed,
        kCorners,
        {length("width", "1", "width in every direction")}},
       shapes::reuleaux},
      {{"stadium",
        "two half circles of radius r joined by two lines of the given length",
        "(-length/2, -r), the start of the lower line",
        "whole stretches fit; curvature jumps where line and arc meet",
        kClosed,
        kSmooth,
        {length("length", "2", "of each straight side"), length("r", "1", "radius of the ends")}},
       shapes::stadium},
      {{"rounded-rectangle",
        "width by height, its corners rounded with radius r",
        "(-width/2 + r, -height/2), the start of the lower side",
        "whole stretches fit; curvature jumps where line and arc meet",
        kClosed,
        kSmooth,
        {length("width", "3", "outer size along x"), length("height", "2", "outer size along y"),
         length("r", "0.5", "radius of the corners, below half of either")}},
       shapes::rounded_rectangle},
      {{"polygon",
        "regular, corners at r (cos 2 pi i/n, sin 2 pi i/n)",
        "the corner (r, 0)",
        "every place on a side fits as well as any other",
        kClosed,
        kCorners,
        {whole("n", "6", "number of corners", 3, 10000), length("r", "1", "radius of the circle through the corners")}},
       shapes::polygon},
  };
}

/// Curves with two ends.
std::vector<Entry> open_shapes() {
  return {
      {{"log-spiral",
        "r = a e^(b u)",
        "(a, 0)",
        "no inflection and no vertex at all",
        kOpen,
        kSmooth,
        {length("a", "1", "radius at the start"), number("b", "0.1", "growth per radian, not 0", -100, 100),
         number("turns", "2", "how often it goes round", 1e-6, 1000)}},
       shapes::log_spiral},
      {{"exponential",
        "x = scale u, y = scale e^u, from <= u <= to",
        "u = from",
        "one vertex, at u = -ln(2)/2, and no inflection",
        kOpen,
        kSmooth,
        {number("from", "-3", "where u starts", -25, 25), number("to", "2", "where u ends", -25, 25),
         length("scale", "1", "unit of both axes")}},
       shapes::exponential},
  };
}

/// All rows, in the order of the help; made once.
const std::vector<Entry>& entries() {
  // A static of the function: there when another file's static asks for it.
  static const std::vector<Entry> table = [] {
    std::vector<Entry> all = round_shapes();
    for (const auto& more : {drawn_shapes(), open_shapes()}) all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

/// Throws InputError: no shape of this name; the message has the names and the nearest.
const Entry& find_entry(const std::string& name) {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) {
    if (entry.shape.name == name) return entry;
    names.push_back(entry.shape.name);
  }
  throw InputError(fmt::format("there is no gallery shape '{}'; {}", name, known_names(name, names)));
}

}  // namespace

/// The table without the functions, for help and documentation.
const std::vector<GalleryShape>& gallery_shapes() {
  static const std::vector<GalleryShape> shapes = [] {
    std::vector<GalleryShape> result;
    for (const Entry& entry : entries()) result.push_back(entry.shape);
    return result;
  }();
  return shapes;
}

/// The name is made of the parameters as given, defaults left out: it gives the same outline again.
Outline gallery(const std::string& shape, const ParameterList& parameters) {
  const Entry& entry = find_entry(shape);
  Outline outline;
  outline.name = "gallery:" + shape;
  // As the user wrote them, and in that order.
  for (const auto& [name, value] : parameters) outline.name += fmt::format(",{}={}", name, value);
  // From this specification the same curves can be made again.
  outline.gallery = outline.name;
  outline.closed = entry.shape.closed;
  // The parameters are checked first, each by itself; the shape refuses what does not go together.
  outline.curves = entry.build(Parameters(entry.shape, parameters));
  return outline;
}

Outline gallery(const std::string& specification) {
  const std::string prefix = "gallery:";
  const bool has_prefix = specification.rfind(prefix, 0) == 0;
  const std::vector<std::string_view> parts =
      split(std::string_view(specification).substr(has_prefix ? prefix.size() : 0), ',');
  ParameterList parameters;
  // The first part is the shape's name, each further one "key=value".
  for (std::size_t i = 1; i < parts.size(); ++i) {
    // A part without "=": most likely a decimal comma, which split the number.
    const std::size_t equals = parts[i].find('=');
    if (equals == std::string_view::npos) {
      throw InputError(
          fmt::format("'{}' in '{}': expected a parameter as in gallery:ellipse,a=2,b=1{}", parts[i], specification,
                      parse_number(trimmed(parts[i])) ? "; numbers take a decimal point, not a comma" : ""));
    }
    parameters.emplace_back(trimmed(parts[i].substr(0, equals)), trimmed(parts[i].substr(equals + 1)));
  }
  return gallery(std::string(parts.front()), parameters);
}

}  // namespace rollfix
