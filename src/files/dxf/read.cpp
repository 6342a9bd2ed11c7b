#include "files/dxf/read.hpp"

#include <fmt/format.h>

namespace rollfix::dxf {

std::size_t NameTable::number_of(std::string_view raw) {
  if (!names_.empty() && raw == last_raw_) return last_;
  std::string name = decoded(raw);
  const auto [entry, is_new] = numbers_.emplace(folded(name), names_.size());
  if (is_new) names_.push_back(std::move(name));
  last_raw_ = raw;
  last_ = entry->second;
  return last_;
}

namespace {

/// A frozen layer's bit in its flags.
constexpr std::int64_t kFrozen = 1;
/// A block's bits for what another file holds: a reference, or one laid over.
constexpr std::int64_t kExternal = 4 | 8;

// Each of these starts behind the section's name and ends at the group 0 that ends the section, which read_model
// checks.

bool ends_section(const Tag& tag) { return starts(tag, "ENDSEC") || starts(tag, "SECTION") || starts(tag, "EOF"); }

void read_layer(Cursor& cursor, Model& model) {
  std::string_view name;
  Layer layer;
  for (cursor.advance(); cursor.tag.code != 0; cursor.advance()) {
    switch (cursor.tag.code) {
      case 2:
        name = text_of(cursor.tag);
        break;
      case 62:
        layer.off = whole_of(cursor.tag, cursor.reader) < 0;
        break;  // the colour's number, negative when off
      case 70:
        layer.frozen = (whole_of(cursor.tag, cursor.reader) & kFrozen) != 0;
        break;
      default:
        break;
    }
  }
  item_at(model.layers, model.layer_names.number_of(name)) = layer;
}

void read_block(Cursor& cursor, Model& model) {
  const std::size_t place = cursor.tag.place;
  Block block;
  block.defined = true;
  std::string_view name;
  for (cursor.advance(); cursor.tag.code != 0; cursor.advance()) {
    const Tag& tag = cursor.tag;
    switch (tag.code) {
      case 2:
        name = text_of(tag);
        break;
      case 10:
        block.base.x() = real_of(tag, cursor.reader);
        break;
      case 20:
        block.base.y() = real_of(tag, cursor.reader);
        break;
      case 30:
        block.base.z() = real_of(tag, cursor.reader);
        break;
      case 70:
        block.external = (whole_of(tag, cursor.reader) & kExternal) != 0;
        break;
      default:
        break;
    }
  }
  const std::string whose = fmt::format("block '{}'", shown(name));
  const std::size_t number = model.block_names.number_of(name);
  read_entities(cursor, model, block.entities, "ENDBLK", whose);
  cursor.skip_record();
  Block& known = item_at(model.blocks, number);
  if (known.defined) {
    known.again = place;
  } else {
    known = std::move(block);
  }
}

void read_header(Cursor& cursor, Model& model) {
  std::string_view variable;
  for (cursor.advance(); cursor.tag.code != 0; cursor.advance()) {
    const Tag& tag = cursor.tag;
    if (tag.code == 9) variable = text_of(tag);
    if (tag.code == 70 && variable == "$INSUNITS") model.units = whole_of(tag, cursor.reader);
    if (tag.code == 70 && variable == "$MEASUREMENT") model.measurement = whole_of(tag, cursor.reader);
  }
}

void read_tables(Cursor& cursor, Model& model) {
  cursor.advance();
  while (!ends_section(cursor.tag)) {
    if (starts(cursor.tag, "LAYER")) {
      read_layer(cursor, model);
    } else {
      cursor.skip_record();
    }
  }
}

void read_blocks(Cursor& cursor, Model& model) {
  cursor.advance();
  while (starts(cursor.tag, "BLOCK")) read_block(cursor, model);
}

}  // namespace

Model read_model(TagReader& reader) {
  Model model;
  Cursor cursor{reader, {}};
  bool has_entities = false;
  for (cursor.advance(); !starts(cursor.tag, "EOF"); cursor.advance()) {
    if (!starts(cursor.tag, "SECTION")) {
      cursor.refuse(fmt::format("found group code {} with '{}', expected 0 with SECTION or EOF", cursor.tag.code,
                                shown(text_of(cursor.tag))));
    }
    const std::size_t place = cursor.tag.place;
    cursor.advance();
    if (cursor.tag.code != 2) cursor.refuse("expected a section's name (group code 2)");
    const std::string_view name = text_of(cursor.tag);
    if (name == "HEADER") {
      read_header(cursor, model);
    } else if (name == "TABLES") {
      read_tables(cursor, model);
    } else if (name == "BLOCKS") {
      read_blocks(cursor, model);
    } else if (name == "ENTITIES") {
      cursor.advance();
      read_entities(cursor, model, model.entities, "ENDSEC", "section ENTITIES");
      has_entities = true;
    } else {
      cursor.advance();
      while (!ends_section(cursor.tag)) cursor.skip_record();
    }
    if (!starts(cursor.tag, "ENDSEC")) {
      cursor.refuse(
          fmt::format("found group code {} with '{}', expected 0 ENDSEC, the end of section {} that starts at {}",
                      cursor.tag.code, shown(text_of(cursor.tag)), shown(name), reader.where(place)));
    }
  }
  if (!has_entities) cursor.refuse("the file ends without a section ENTITIES, which holds what is drawn");
  return model;
}

}  // namespace rollfix::dxf
