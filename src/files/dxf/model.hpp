#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

namespace rollfix::dxf {

// What a file says, before anything is placed, hidden or drawn.

using Vec3 = Eigen::Vector3d;

/// Numbers for names that differ in more than the case of their letters.
class NameTable {
 public:
  /// The name's number, a new one where the name is new; as it stands in the file.
  std::size_t number_of(std::string_view raw);

  /// In UTF-8, spelled as where it was first seen.
  const std::string& name(std::size_t number) const { return names_[number]; }
  std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> numbers_;  // by the folded name
  std::string last_raw_;                                  // neighbours often share a name
  std::size_t last_ = 0;
};

struct LineShape {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
};

/// ARC and CIRCLE, counter-clockwise as seen against the extrusion.
struct ArcShape {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  double start = 0;  // degrees
  double end = 360;
};

struct EllipseShape {
  Vec3 centre = Vec3::Zero();
  Vec3 major = Vec3::Zero();  // the longer half axis
  double ratio = 1;           // of the other to it
  double start = 0;           // parameters, radians
  double end = 0;
};

struct Vertex {
  Vec3 point = Vec3::Zero();
  double bulge = 0;  // tan(sweep / 4) of the arc to the next vertex, 0 for a line
};

/// LWPOLYLINE and POLYLINE.
struct PolylineShape {
  std::vector<Vertex> vertices;
  bool closed = false;
  bool spatial = false;     // a 3D polyline: its points are not turned by the extrusion
  bool wide = false;        // has widths
  bool spline_fit = false;  // the vertices stand for a spline
};

struct SplineShape {
  std::int64_t degree = 0;
  bool closed = false;
  std::vector<double> knots;
  std::vector<double> weights;
  std::vector<Vec3> controls;
  std::vector<Vec3> fits;
};

struct InsertShape {
  std::size_t block = 0;  // number in Model::blocks
  Vec3 at = Vec3::Zero();
  Vec3 scale = Vec3::Ones();
  double rotation = 0;  // degrees
  std::int64_t columns = 1;
  std::int64_t rows = 1;
  double column_spacing = 0;
  double row_spacing = 0;
};

/// What is counted and left out.
struct OtherShape {};

using Shape = std::variant<OtherShape, LineShape, ArcShape, EllipseShape, PolylineShape, SplineShape, InsertShape>;

struct Entity {
  std::size_t type = 0;   // number in Model::types
  std::size_t layer = 0;  // number in Model::layers
  std::size_t place = 0;
  Vec3 extrusion = Vec3::UnitZ();
  bool invisible = false;
  bool paper = false;  // on a sheet of paper, not in the model
  Shape shape;
};

struct Layer {
  bool off = false;
  bool frozen = false;
};

struct Block {
  bool defined = false;
  bool external = false;               // in another file
  std::optional<std::size_t> again{};  // place of a second definition
  Vec3 base = Vec3::Zero();
  std::vector<Entity> entities;
};

/// A list that is indexed by the numbers of a name table and as long as it needs to be.
template <class Item>
Item& item_at(std::vector<Item>& items, std::size_t number) {
  if (number >= items.size()) items.resize(number + 1);
  return items[number];
}

struct Model {
  Model() { item_at(layers, layer_names.number_of("0")); }

  std::optional<std::int64_t> units;        // $INSUNITS
  std::optional<std::int64_t> measurement;  // $MEASUREMENT
  NameTable types;
  NameTable layer_names;
  std::vector<Layer> layers;  // 0 is layer "0"
  NameTable block_names;
  std::vector<Block> blocks;
  std::vector<Entity> entities;
};

inline constexpr std::size_t kLayerZero = 0;

}  // namespace rollfix::dxf
