#pragma once

#include <string>
#include <string_view>

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

// Each starts behind the section's name and ends at the group 0 that ends the section, which read_model checks.
void read_header(Cursor& cursor, Model& model);
void read_tables(Cursor& cursor, Model& model);
void read_blocks(Cursor& cursor, Model& model);

/// Reads entities, starting at the first one's group 0, up to the record of that name; the section or block is
/// `whose`. Throws InputError when something ends before.
void read_entities(Cursor& cursor, Model& model, std::vector<Entity>& entities, std::string_view end,
                   const std::string& whose);

}  // namespace rollfix::dxf
