#pragma once

#include <cstdint>
#include <string>

#include "files/dxf/model.hpp"
#include "files/dxf/read.hpp"

namespace rollfix::dxf {

/// A point that is read one coordinate at a time.
struct PointParts {
  Vec3 point = Vec3::Zero();
  bool has_x = false;
  bool has_y = false;
};

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

  /// Takes the group if it is x, y or z of the point whose x has this code.
  bool take(PointParts& parts, int code_of_x) const;

  /// Takes the group if it is a part of the direction from which the entity was drawn.
  bool take_extrusion();

  /// Throws InputError unless the point was there.
  void require(const PointParts& parts, int code_of_x) const;
  void require(bool found, const std::string& what) const;
  /// Throws InputError at the entity's start ...
  [[noreturn]] void refuse(const std::string& what) const;
  /// ... or at the group that was read last.
  [[noreturn]] void refuse_here(const std::string& what) const { cursor_.refuse(what); }

  Entity& entity() { return entity_; }
  Cursor& cursor() { return cursor_; }
  Model& model() { return model_; }
  const std::string& type() const { return model_.types.name(entity_.type); }

 private:
  bool take_common();

  Cursor& cursor_;
  Model& model_;
  Entity entity_;
  bool in_group_ = false;     // between 102 { and 102 }
  bool in_embedded_ = false;  // behind 101
};

/// LWPOLYLINE. Throws InputError.
Shape read_light_polyline(EntityTags& tags);

/// POLYLINE with its VERTEX records up to SEQEND; a mesh is an OtherShape. Throws InputError.
Shape read_polyline(EntityTags& tags);

}  // namespace rollfix::dxf
