#include "files/dxf/entity_tags.hpp"

#include <fmt/format.h>

#include "files/dxf/text.hpp"

namespace rollfix::dxf {

namespace {

/// From here on the group codes are those of extended data, which programs append for themselves.
constexpr int kExtended = 1000;

}  // namespace

EntityTags::EntityTags(Cursor& cursor, Model& model) : cursor_(cursor), model_(model) {
  entity_.type = model.types.number_of(text_of(cursor.tag));
  entity_.layer = kLayerZero;
  entity_.place = cursor.tag.place;
}

bool EntityTags::next() {
  for (cursor_.advance(); cursor_.tag.code != 0; cursor_.advance()) {
    if (!take_common()) return true;
  }
  return false;
}

bool EntityTags::take_common() {
  const int code = cursor_.tag.code;
  if (code == 102) in_group_ = !text_of(cursor_.tag).empty() && text_of(cursor_.tag).front() == '{';
  if (code == 101) in_embedded_ = true;
  if (in_group_ || in_embedded_ || code >= kExtended || code == 102) return true;
  switch (code) {
    case 8:
      entity_.layer = model_.layer_names.number_of(text_of(cursor_.tag));
      item_at(model_.layers, entity_.layer);
      return true;
    case 60:
      entity_.invisible = whole() != 0;
      return true;
    case 67:
      entity_.paper = whole() != 0;
      return true;
    default:
      return false;
  }
}

bool EntityTags::take(PointParts& parts, int code_of_x) const {
  const int axis = code() - code_of_x;
  switch (axis) {
    case 0:
      parts.has_x = true;
      break;
    case 10:
      parts.has_y = true;
      break;
    case 20:
      break;
    default:
      return false;
  }
  parts.point[axis / 10] = real();
  return true;
}

bool EntityTags::take_extrusion() {
  PointParts parts{entity_.extrusion};
  if (!take(parts, 210)) return false;
  entity_.extrusion = parts.point;
  return true;
}

void EntityTags::refuse(const std::string& what) const {
  dxf::refuse(cursor_.reader, entity_.place, fmt::format("{} {}", shown(type()), what));
}

void EntityTags::require(bool found, const std::string& what) const {
  if (!found) refuse("without " + what);
}

void EntityTags::require(const PointParts& parts, int code_of_x) const {
  require(parts.has_x && parts.has_y, fmt::format("its point (group codes {} and {})", code_of_x, code_of_x + 10));
}

}  // namespace rollfix::dxf
