#pragma once

#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "files/dxf/model.hpp"
#include "files/dxf/tags.hpp"

namespace rollfix::dxf {

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

}  // namespace rollfix::dxf
