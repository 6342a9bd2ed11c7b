#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "outline/box.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::dxf {

/// A name or a text of the file in UTF-8: old files hold Windows-1252 and write other letters as \U+00E4.
std::string decoded(std::string_view text);

/// A piece of the file as a message can show it: on one line and not too long.
std::string shown(std::string_view text);

/// Names of layers and blocks are the same whatever the case of their letters.
std::string folded(std::string_view name);

/// The highest group code there is, and that of comments.
inline constexpr int kMostCode = 1071;
inline constexpr int kComment = 999;

/// One group of a DXF file: what it is about (the code) and the value. An ASCII file's values are all text until they
/// are asked for; a binary file's are what the code's type makes them.
struct Tag {
  int code = 0;
  std::size_t place = 0;  // the value's line from 1; of a binary file the group's first byte from 0
  std::variant<std::string_view, double, std::int64_t> value;
};

/// Goes through the groups of a file without copying it; comments (code 999) are passed over.
class TagReader {
 public:
  virtual ~TagReader() = default;

  /// The next group. It is an error to ask beyond 0 EOF: without one the file has been cut short.
  virtual void next(Tag& tag) = 0;

  /// "part.dxf:12" or "part.dxf: byte 340", for messages.
  virtual std::string where(std::size_t place) const = 0;
};

/// The group's value as text; empty for a number of a binary file.
std::string_view text_of(const Tag& tag);

/// Whether this is the group 0 that starts this kind of record.
bool starts(const Tag& tag, std::string_view record);

/// The group's value as a number. Throws InputError: not a number, not finite, above kMostCoordinate.
double real_of(const Tag& tag, const TagReader& reader);

/// The group's value as a whole number. Throws InputError otherwise.
std::int64_t whole_of(const Tag& tag, const TagReader& reader);

/// Throws InputError with the place in front of what is wrong there.
[[noreturn]] void refuse(const TagReader& reader, std::size_t place, const std::string& what);

/// The reader for these bytes, ASCII or binary, which must stay. Throws InputError when they are not a DXF file's.
std::unique_ptr<TagReader> open_tags(std::string_view bytes, const std::string& name);

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

/// A reader with the group that was read last.
struct Cursor {
  TagReader& reader;
  Tag tag;

  void advance() { reader.next(tag); }
  /// To the next group 0, past what a record holds.
  void skip_record() {
    do advance();
    while (tag.code != 0);
  }
  [[noreturn]] void refuse(const std::string& what) const { dxf::refuse(reader, tag.place, what); }
};

/// The whole file. Throws InputError naming line and value.
Model read_model(TagReader& reader);

/// Reads entities, starting at the first one's group 0, up to the record of that name; the section or block is
/// `whose`. Throws InputError when something ends before.
void read_entities(Cursor& cursor, Model& model, std::vector<Entity>& entities, std::string_view end,
                   const std::string& whose);

/// Goes through one entity's groups. What all kinds share goes into the entity, what programs append for themselves is
/// passed over; the rest is for the caller.
class EntityTags {
 public:
  /// The cursor stands at the entity's group 0.
  EntityTags(Cursor& cursor, Model& model);

  /// The next group of the entity's own, false when the next record begins.
  bool next();

  int code() const { return cursor_.tag.code; }
  double real() const { return real_of(cursor_.tag, cursor_.reader); }
  std::int64_t whole() const { return whole_of(cursor_.tag, cursor_.reader); }

  /// Takes the group if it has this code, or is x, y or z of the point whose x has it.
  bool take(int code, double& into);
  bool take(int code, std::int64_t& into);
  bool take(int code_of_x, Vec3& into);
  /// Takes the group if it is a part of the direction from which the entity was drawn.
  bool take_extrusion() { return take(210, entity_.extrusion); }

  /// Throws InputError unless groups of these codes, or x and y of the point, were taken.
  void require(std::initializer_list<int> codes, const std::string& what) const;
  void require_point(int code_of_x) const;
  void require(bool found, const std::string& what) const;
  /// Throws InputError unless as many things were found as the group of this code, if it was taken, says.
  void require_count(int code, std::int64_t said, std::size_t found, std::string_view things) const;
  /// Throws InputError at the entity's start ...
  [[noreturn]] void refuse(const std::string& what) const;
  /// ... or at the group that was read last.
  [[noreturn]] void refuse_here(const std::string& what) const { cursor_.refuse(what); }

  Entity& entity() { return entity_; }
  Cursor& cursor() { return cursor_; }
  Model& model() { return model_; }

 private:
  bool take_common();

  Cursor& cursor_;
  Model& model_;
  Entity entity_;
  std::bitset<kMostCode + 1> taken_;  // codes
  bool in_group_ = false;             // between 102 { and 102 }
  bool in_embedded_ = false;          // behind 101
};

/// LWPOLYLINE. Throws InputError.
Shape read_light_polyline(EntityTags& tags);

/// POLYLINE with its VERTEX records up to SEQEND; a mesh is an OtherShape. Throws InputError.
Shape read_polyline(EntityTags& tags);

/// How a block's flat content comes to lie in the drawing: an affine map of the plane, and its height above it.
struct Placement {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Vec2 offset = Vec2::Zero();
  double height_scale = 1;
  double height_offset = 0;

  Vec2 vector(const Vec2& v) const { return linear * v; }
  Vec2 point(const Vec3& p) const { return linear * p.head<2>() + offset; }
  double height(const Vec3& p) const { return height_scale * p.z() + height_offset; }
};

/// First `inner`, then `outer`.
Placement composed(const Placement& outer, const Placement& inner);

/// From the coordinates of an entity that was drawn from this direction; nothing unless it is (0, 0, 1), which changes
/// nothing, or (0, 0, -1), which mirrors x (the "arbitrary axis algorithm" of the format).
std::optional<Placement> facing(const Vec3& extrusion);

/// From a block's coordinates to those in which its INSERT is drawn, for one cell of the array.
Placement cell_of(const InsertShape& insert, const Vec3& base, std::int64_t column, std::int64_t row);

/// What a drawing lost on the way, counted for the user to read.
struct Tally {
  std::map<std::string, std::size_t> others;  // by the kind of entity
  std::size_t hidden = 0;                     // on layers that are off or frozen
  std::size_t invisible = 0;
  std::size_t paper = 0;
  std::size_t other_layers = 0;
  std::size_t without_length = 0;
  std::size_t negative = 0;    // circles of a radius below 0
  std::size_t wide = 0;        // polylines with widths
  std::size_t spline_fit = 0;  // polylines that stand for a spline
  std::size_t fit_points = 0;  // splines without control points
  std::size_t repeated = 0;    // points of theirs that repeat the one before
};

/// Where placed shapes become curves.
class Canvas {
 public:
  Canvas(const TagReader& reader, const Model& model, Drawing& drawing, Tally& tally)
      : reader_(reader), model_(model), drawing_(drawing), tally_(tally) {}

  /// Draws a shape that is not an INSERT. `layer` is where it comes to lie.
  /// Throws InputError: out of range, not parallel to the plane, or no curve (a spline's knots that fall).
  void draw(const Entity& entity, const Placement& placement, std::size_t layer);

  /// The map from the coordinates in which this entity is drawn. Throws InputError where it is tilted.
  Placement placement_of(const Entity& entity, const Placement& outer) const;

  /// Throws InputError unless all that was drawn lies at one height; notes a height that is not 0.
  void require_flat() const;

 private:
  void draw_shape(const OtherShape& shape, const Placement& outer);
  void draw_shape(const LineShape& line, const Placement& outer);
  void draw_shape(const ArcShape& arc, const Placement& outer);
  void draw_shape(const EllipseShape& ellipse, const Placement& outer);
  void draw_shape(const PolylineShape& line, const Placement& outer);
  void draw_shape(const SplineShape& spline, const Placement& outer);
  void draw_shape(const InsertShape&, const Placement&) {}

  /// Where the point comes to lie. Throws InputError beyond kMostCoordinate.
  Vec2 placed(const Placement& placement, const Vec3& point);
  std::vector<Vec2> placed(const Placement& placement, const std::vector<Vec3>& points);
  void draw_line(const Placement& placement, const Vec3& from, const Vec3& to);
  void draw_line(const Vec2& from, const Vec2& to);
  void draw_arc(const Placement& placement, const Vec3& centre, const Vec2& major, const Vec2& minor, double from,
                double sweep);
  void draw_bulge(const Placement& placement, const Vertex& from, const Vertex& to);
  std::vector<Curve> curves_of(const SplineShape& spline, const Placement& outer);
  void take(Curve curve);

  /// What `make` makes; its InputError gets the entity's place in front.
  template <class Make>
  auto made(const Make& make) const;
  [[noreturn]] void refuse(const std::string& what) const;

  const TagReader& reader_;
  const Model& model_;
  Drawing& drawing_;
  Tally& tally_;
  const Entity* entity_ = nullptr;  // being drawn
  std::size_t layer_ = 0;

  Box box_;  // around all points
  bool any_ = false;
  double first_height_ = 0;
  double other_height_ = 0;  // the farthest from the first
  std::size_t other_place_ = 0;
};

}  // namespace rollfix::dxf
