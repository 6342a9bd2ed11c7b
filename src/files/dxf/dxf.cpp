#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "files/dxf/read.hpp"
#include "files/formats.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"

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

// ---- the drawing

namespace {

/// As many curves, points and cells of arrays may come out of INSERTs: ten times what a large drawing has. A file of a
/// few hundred bytes could ask for any number.
constexpr std::size_t kMostInserted = 1'000'000;
/// INSERTs may be nested as deep.
constexpr int kMostNested = 100;

/// By the number that $INSUNITS has; 0 is no unit.
constexpr std::array<const char*, 25> kUnits = {"",    "in", "ft",       "mi",    "mm",    "cm",    "m",    "km", "uin",
                                                "mil", "yd", "angstrom", "nm",    "um",    "dm",    "dam",  "hm", "Gm",
                                                "au",  "ly", "pc",       "us-ft", "us-in", "us-yd", "us-mi"};

/// Sets the drawing's unit from $INSUNITS, or where that says nothing from $MEASUREMENT, and notes the latter.
void set_unit(const Model& model, Drawing& drawing) {
  const std::int64_t number = model.units.value_or(0);
  if (number > 0 && number < static_cast<std::int64_t>(kUnits.size())) {
    drawing.unit = kUnits[static_cast<std::size_t>(number)];
    return;
  }
  if (number != 0) {
    drawing.notes.push_back(
        fmt::format("the header's unit ($INSUNITS) is {}, which means nothing: none is taken", number));
    return;
  }
  if (!model.measurement || *model.measurement < 0 || *model.measurement > 1) return;
  drawing.unit = *model.measurement == 1 ? "mm" : "in";
  drawing.notes.push_back(fmt::format("the header names no unit, but says {} ($MEASUREMENT): taken as {}",
                                      *model.measurement == 1 ? "metric" : "English", drawing.unit));
}

/// How much a shape brings to the drawing, counted in lines.
std::size_t cost_of(const Shape& shape) {
  if (const auto* line = std::get_if<PolylineShape>(&shape)) return 1 + line->vertices.size();
  if (const auto* spline = std::get_if<SplineShape>(&shape)) {
    // A piece of a spline holds degree + 1 points.
    const auto points_of_a_piece = static_cast<std::size_t>(std::clamp<std::int64_t>(spline->degree, 0, kMostDegree));
    return 1 + (spline->controls.size() + spline->fits.size()) * (1 + points_of_a_piece / 4);
  }
  return 1;
}

/// As many kinds of entities are named; a file can make up any number.
constexpr std::size_t kMostNamed = 20;

std::string others_of(const Tally& tally) {
  std::string text;
  std::size_t named = 0;
  for (const auto& [kind, count] : tally.others) {
    if (named == kMostNamed) {
      text += fmt::format(" and {} more kinds", tally.others.size() - named);
      break;
    }
    text += fmt::format("{}{} {}", named == 0 ? "" : ", ", count, shown(kind));
    ++named;
  }
  return text;
}

/// One line each. `layer` is the one that was asked for.
std::vector<std::string> notes_of(const Tally& tally, const std::string& layer) {
  std::vector<std::string> notes;
  const auto left_out = [&notes](std::size_t count, const std::string& what) {
    if (count > 0) notes.push_back(fmt::format("left out: {} {}", counted(count, "entity", "entities"), what));
  };
  if (!tally.others.empty()) notes.push_back("left out: " + others_of(tally));
  left_out(tally.hidden, "on layers that are off or frozen");
  left_out(tally.invisible, "marked as invisible");
  left_out(tally.paper, "in paper space");
  left_out(tally.other_layers, fmt::format("on other layers than '{}'", shown(layer)));
  if (tally.negative > 0) {
    notes.push_back(fmt::format("left out: {} of a radius below 0", counted(tally.negative, "circle", "circles")));
  }
  if (tally.without_length > 0) {
    notes.push_back(fmt::format("left out: {} without length (between equal points or of radius 0)",
                                counted(tally.without_length, "curve", "curves")));
  }
  if (tally.wide > 0) {
    notes.push_back(fmt::format("left out: the widths of {}; their centre lines are taken",
                                counted(tally.wide, "polyline", "polylines")));
  }
  if (tally.spline_fit > 0) {
    notes.push_back(fmt::format("{} for a spline: the chords in the file are taken",
                                counted(tally.spline_fit, "polyline stands", "polylines stand")));
  }
  if (tally.fit_points > 0) {
    notes.push_back(
        fmt::format("{} fit points only: a cubic spline in chord length through them is taken, "
                    "which another program may draw differently between them",
                    counted(tally.fit_points, "spline has", "splines have")));
  }
  if (tally.repeated > 0) {
    notes.push_back(fmt::format("left out: {} of splines that repeat the one before",
                                counted(tally.repeated, "fit point", "fit points")));
  }
  return notes;
}

class Expansion {
 public:
  Expansion(const Model& model, const TagReader& reader, const std::string& layer, Drawing& drawing)
      : model_(model), reader_(reader), canvas_(reader, model, drawing, tally_), open_(model.blocks.size(), false) {
    if (!layer.empty()) wanted_ = number_of(layer, drawing.name);
  }

  /// Draws entities that a block holds, or the drawing itself: `insert_layer` is then layer 0.
  void draw_all(const std::vector<Entity>& entities, const Placement& placement, std::size_t insert_layer) {
    for (const Entity& entity : entities) {
      // What lies on layer 0 of a block goes with its INSERT.
      const std::size_t layer = entity.layer == kLayerZero ? insert_layer : entity.layer;
      if (depth_ > 0) spend(cost_of(entity.shape), entity.place);
      if (const auto* insert = std::get_if<InsertShape>(&entity.shape)) {
        draw_insert(entity, *insert, placement, layer);
      } else if (is_shown(entity, layer)) {
        canvas_.draw(entity, placement, layer);
      }
    }
  }

  const Tally& tally() const { return tally_; }
  const Canvas& canvas() const { return canvas_; }

 private:
  std::size_t number_of(const std::string& wanted, const std::string& name) const {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < model_.layer_names.size(); ++k) {
      names.push_back(model_.layer_names.name(k));
      if (folded(names.back()) == folded(wanted)) return k;
    }
    throw InputError(fmt::format("{}: has no layer '{}'; {}", name, wanted, known_names(wanted, names)));
  }

  /// A layer that was asked for is shown even where it is off.
  bool is_hidden(std::size_t layer, bool as_a_whole) const {
    const Layer& its = model_.layers[layer];
    return layer != wanted_ && (its.frozen || (its.off && !as_a_whole));
  }

  /// Counts what is not.
  bool is_shown(const Entity& entity, std::size_t layer) {
    if (!shows_any(entity, layer)) return false;
    if (wanted_ && layer != *wanted_) {
      ++tally_.other_layers;
    } else if (is_hidden(layer, false)) {
      ++tally_.hidden;
    } else {
      return true;
    }
    return false;
  }

  /// Whether the entity, or if it is an INSERT anything of it, is shown: where its layer is off that goes on.
  bool shows_any(const Entity& entity, std::size_t layer) {
    if (entity.paper && depth_ == 0) {
      ++tally_.paper;
    } else if (entity.invisible) {
      ++tally_.invisible;
    } else if (is_hidden(layer, true) && !wanted_) {
      ++tally_.hidden;
    } else {
      return true;
    }
    return false;
  }

  void draw_insert(const Entity& entity, const InsertShape& insert, const Placement& placement, std::size_t layer) {
    if (!shows_any(entity, layer)) return;
    const Block& block = model_.blocks[insert.block];
    const std::string name = shown(model_.block_names.name(insert.block));
    if (!block.defined) {
      refuse(reader_, entity.place, fmt::format("INSERT of block '{}', which the file does not have", name));
    }
    if (block.again) {
      refuse(
          reader_, *block.again,
          fmt::format("block '{}' is defined here again, and which one is meant can't be told: rename one of them, or "
                      "explode what is inserted, and save the drawing anew",
                      name));
    }
    if (block.external) {
      ++tally_.others["INSERT of another file"];
      return;
    }
    if (open_[insert.block]) {
      refuse(reader_, entity.place, fmt::format("INSERT of block '{}' inside itself: that has no end", name));
    }
    if (depth_ == kMostNested) {
      refuse(reader_, entity.place, fmt::format("INSERT of block '{}' is nested more than {} deep", name, kMostNested));
    }
    if (insert.scale.head<2>().cwiseAbs().minCoeff() == 0) {
      refuse(reader_, entity.place, fmt::format("INSERT of block '{}' has a scale of 0, expected another", name));
    }
    const Placement here = canvas_.placement_of(entity, placement);
    open_[insert.block] = true;
    ++depth_;
    for (std::int64_t row = 0; row < insert.rows; ++row) {
      for (std::int64_t column = 0; column < insert.columns; ++column) {
        spend(1, entity.place);
        draw_all(block.entities, composed(here, cell_of(insert, block.base, column, row)), layer);
      }
    }
    --depth_;
    open_[insert.block] = false;
  }

  void spend(std::size_t cost, std::size_t place) {
    spent_ += cost;
    if (spent_ <= kMostInserted) return;
    refuse(reader_, place,
           fmt::format("up to here the INSERTs bring more than {} curves, points and cells, expected fewer",
                       kMostInserted));
  }

  const Model& model_;
  const TagReader& reader_;
  Tally tally_;
  Canvas canvas_;
  std::optional<std::size_t> wanted_;  // layer
  std::vector<bool> open_;             // blocks that are being drawn
  int depth_ = 0;
  std::size_t spent_ = 0;
};

/// Draws all that is shown of the file, or what is on the layer (empty: any), into the drawing's curves and notes.
/// Throws InputError: no such layer or block, nesting without end, more than kMostInserted.
void expand(const Model& model, const TagReader& reader, const std::string& layer, Drawing& drawing) {
  Expansion expansion(model, reader, layer, drawing);
  expansion.draw_all(model.entities, {}, kLayerZero);
  std::vector<std::string> notes = notes_of(expansion.tally(), layer);
  for (std::size_t k = 0; k < model.blocks.size(); ++k) {
    if (!model.blocks[k].again) continue;
    notes.push_back(
        fmt::format("block '{}' is defined more than once, and not drawn", shown(model.block_names.name(k))));
  }
  drawing.notes.insert(drawing.notes.end(), notes.begin(), notes.end());
  expansion.canvas().require_flat();
}

}  // namespace
}  // namespace rollfix::dxf

namespace rollfix::files {

Drawing parse_dxf(std::string_view bytes, const std::string& name, const DxfOptions& options) {
  const std::unique_ptr<dxf::TagReader> reader = dxf::open_tags(bytes, name);
  const dxf::Model model = dxf::read_model(*reader);
  Drawing drawing;
  drawing.name = name;
  dxf::set_unit(model, drawing);
  dxf::expand(model, *reader, options.layer, drawing);
  return drawing;
}

}  // namespace rollfix::files
