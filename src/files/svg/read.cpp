#include "files/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "files/svg/document.hpp"
#include "files/svg/shapes.hpp"
#include "outline/refusals.hpp"
#include "text/text.hpp"

namespace rollfix::files {

namespace {

using namespace svg;

/// Elements inside each other. Far above what drawing programs write, and within a stack of 64 kB.
constexpr int kMostNesting = 150;
/// Elements and segments that <use> may copy in all: ten uses of ten uses, and so on, would never end.
constexpr std::size_t kMostCopies = 1000000;
/// So much text, read again for a copy, counts as one of them.
constexpr std::size_t kTextOfACopy = 64;
/// A transformation whose determinant is below this share of its size squared is singular but for rounding.
constexpr double kSingular = 1e-14;

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Elements whose children are drawn where they stand.
bool is_group(std::string_view kind) {
  constexpr std::array<std::string_view, 4> kGroups = {"g", "a", "svg", "switch"};
  return is_one_of(kind, kGroups);
}

/// Elements that draw nothing where they stand.
bool is_definition(std::string_view kind) {
  constexpr std::array<std::string_view, 15> kDefinitions = {
      "defs",     "symbol", "clipPath", "mask",  "marker", "pattern", "linearGradient", "radialGradient", "filter",
      "metadata", "title",  "desc",     "style", "script", "view"};
  return is_one_of(kind, kDefinitions);
}

/// Elements that are wrong in one way.
struct Wrong {
  std::size_t count = 0;
  std::size_t first = 0;  // its line

  void add(std::size_t line) {
    if (count++ == 0) first = line;
  }
};

/// What was left out, for the user to read.
struct LeftOut {
  std::map<std::string, std::size_t> by_name;
  std::size_t hidden = 0;
  std::size_t without_size = 0;
  std::size_t without_length = 0;
  Wrong singular;
  Wrong below_zero;
  Wrong dangling;
  std::size_t clipped = 0;
  std::size_t style_sheets = 0;

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    std::vector<std::string> names;
    for (const auto& [name, count] : by_name) names.push_back(fmt::format("{} {}", count, name));
    if (!names.empty()) notes.push_back(fmt::format("left out: {}", fmt::join(names, ", ")));
    const auto add = [&](std::size_t count, const char* one, const char* many) {
      if (count > 0) notes.push_back("left out: " + counted(count, one, many));
    };
    add(hidden, "hidden element", "hidden elements");
    add(without_size, "element without a size", "elements without a size");
    add(without_length, "segment without length", "segments without length");
    const auto add_wrong = [&](const Wrong& wrong, const char* one, const char* many) {
      if (wrong.count == 0) return;
      notes.push_back(fmt::format("left out: {}, the first on line {}", counted(wrong.count, one, many), wrong.first));
    };
    add_wrong(singular, "element that a singular transform makes flat", "elements that singular transforms make flat");
    add_wrong(below_zero, "element of a size below 0", "elements of a size below 0");
    add_wrong(dangling, "<use> of what is not there", "<use> of what is not there");
    if (clipped > 0)
      notes.push_back(fmt::format("drawn whole: {}", counted(clipped, "clipped element", "clipped elements")));
    if (style_sheets > 0) {
      notes.push_back(fmt::format("not read: {} that may hide or move elements",
                                  counted(style_sheets, "style sheet", "style sheets")));
    }
    return notes;
  }
};

/// What an element takes over from those around it.
struct Surroundings {
  Affine map;
  Vec2 viewport;  // what percentages refer to; not finite where the file does not say
  bool visible = true;
  int depth = 0;
};

/// Finds elements by their id.
class Ids : public pugi::xml_tree_walker {
 public:
  explicit Ids(pugi::xml_node root) {
    for_each(root);
    root.traverse(*this);
  }

  pugi::xml_node find(std::string_view id) const {
    const auto found = nodes_.find(id);
    return found == nodes_.end() ? pugi::xml_node() : found->second;
  }

 private:
  bool for_each(pugi::xml_node& node) override {
    const std::string_view id = node.attribute("id").value();
    if (!id.empty()) nodes_.emplace(id, node);
    return true;
  }

  std::unordered_map<std::string_view, pugi::xml_node> nodes_;
};

class Walker {
 public:
  explicit Walker(const Document& document) : document_(document) {}

  void draw_root() {
    const pugi::xml_node root = document_.root();
    if (const auto transform = document_.attribute(root, "transform")) {
      transform->refuse(transform->text.data(), "the outermost element has a transform, expected it on a <g> inside");
    }
    Surroundings around;
    around.map.linear = Vec2(1, -1).asDiagonal();  // up is up
    around.map = around.map * page(root, around.viewport);
    refuse_style_transform(root);
    inherit_visibility(root, around);
    if (is_displayed(root)) draw_children(root, around);
  }

  std::vector<PlacedSubpath> subpaths;
  LeftOut left_out;
  std::string unit = "px";

 private:
  /// From user units to the page in millimetres, its upper left corner at the origin, where the file gives its size;
  /// else user units stay what they are.
  Affine page(pugi::xml_node root, Vec2& viewport) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const auto size = [&](const char* name, bool& is_physical) {
      const std::optional<Value> value = document_.attribute(root, name);
      const std::optional<svg::Length> length = value && !value->text.empty() ? parse_length(*value) : std::nullopt;
      if (!length) return kUnknown;
      is_physical = is_physical || length->is_physical();
      const double result = length->in_user_units(kUnknown).value_or(kUnknown);
      if (result <= 0)
        value->refuse(value->text.data(), fmt::format("expected a {} above 0, found {}", name, shown(value->text)));
      return result;
    };
    bool is_physical = false;
    const double width = size("width", is_physical);
    viewport = {width, size("height", is_physical)};
    const std::optional<Value> written = document_.attribute(root, "viewBox");
    if (!written) return {};
    const ViewBox box = parse_view_box(*written);
    Vec2 physical = kUserUnit * viewport;
    viewport = box.size;
    if (!is_physical) return {};
    unit = "mm";
    if (std::isnan(physical.x())) physical.x() = physical.y() * box.size.x() / box.size.y();
    if (std::isnan(physical.y())) physical.y() = physical.x() * box.size.y() / box.size.x();
    return fit(box, physical, aspect_ratio(root));
  }

  Value aspect_ratio(pugi::xml_node node) const {
    return document_.attribute(node, "preserveAspectRatio").value_or(Value{document_.text(), "", 0});
  }

  bool is_displayed(pugi::xml_node node) {
    if (document_.property(node, "display") != "none") return true;
    ++left_out.hidden;
    return false;
  }

  void inherit_visibility(pugi::xml_node node, Surroundings& around) const {
    const std::string_view visibility = document_.property(node, "visibility");
    if (visibility == "visible") around.visible = true;
    if (visibility == "hidden" || visibility == "collapse") around.visible = false;
  }

  void refuse_style_transform(pugi::xml_node node) const {
    const std::optional<Value> style = document_.attribute(node, "style");
    if (document_.attribute(node, "transform-origin")) {
      document_.refuse(node, "has a transform-origin, which is not read: write it into the transform");
    }
    if (!style) return;
    if (style->text.find('&') != std::string_view::npos) {
      style->refuse(style->text.data(), fmt::format("the style '{}' uses an entity of its own, which is not read: save "
                                                    "the file as plain SVG",
                                                    shown(style->text)));
    }
    constexpr std::array<std::string_view, 6> kMoving = {
        "transform", "transform-origin", "translate", "rotate", "scale", "d"};
    for (const std::string_view name : kMoving) {
      if (!style_property(style->text, name)) continue;
      style->refuse(style->text.data(), fmt::format("the style has '{}', which is read only as an attribute", name));
    }
  }

  void enter(pugi::xml_node node, Surroundings& around) const {
    refuse_style_transform(node);
    inherit_visibility(node, around);
    if (const auto transform = document_.attribute(node, "transform")) {
      around.map = around.map * parse_transform(*transform);
    }
  }

  /// What is made for a <use>.
  void count_copies(std::size_t number) {
    if (uses_.empty()) return;
    copies_ += number;
    if (copies_ <= kMostCopies) return;
    document_.refuse(uses_.front(), fmt::format("<use> copies more than {} elements and segments", kMostCopies));
  }

  void count_copy(pugi::xml_node node) {
    if (uses_.empty()) return;
    std::size_t text = std::string_view(node.child_value()).size();
    for (const pugi::xml_attribute& attribute : node.attributes()) text += std::string_view(attribute.value()).size();
    count_copies(1 + text / kTextOfACopy);
  }

  void draw_children(pugi::xml_node parent, const Surroundings& around) {
    for (const pugi::xml_node child : parent) {
      count_copies(std::string_view(child.value()).size() / kTextOfACopy);
      if (child.type() == pugi::node_pcdata && std::string_view(child.value()).find('&') != std::string_view::npos) {
        document_.refuse(child,
                         fmt::format("'{}' uses an entity of its own, which is not read: save the file as plain SVG",
                                     shown(child.value())));
      }
      draw(child, around);
    }
  }

  void draw(pugi::xml_node node, Surroundings around) {
    const std::string_view kind = document_.kind(node);
    if (kind == "style") note_style_sheet(node);
    if (kind.empty() || is_definition(kind)) return;
    if (++around.depth > kMostNesting) {
      document_.refuse(node, fmt::format("elements are nested more than {} deep", kMostNesting));
    }
    count_copy(node);
    if (!is_shape(kind) && !is_group(kind) && kind != "use") {
      ++left_out.by_name[shown(kind)];
      return;
    }
    if (!is_displayed(node)) return;
    enter(node, around);
    note_clipped(node);
    if (is_shape(kind)) {
      draw_shape(node, around);
    } else if (kind == "use") {
      draw_use(node, around);
    } else if (kind == "switch") {
      draw_first(node, around);
    } else {
      if (kind == "svg") enter_viewport(node, node, around);
      draw_children(node, around);
    }
  }

  void draw_shape(pugi::xml_node node, const Surroundings& around) {
    if (!around.visible) {
      ++left_out.hidden;
      return;
    }
    std::optional<std::vector<Subpath>> drawn = shape(document_, node, around.viewport);
    if (!drawn) {
      left_out.below_zero.add(document_.line_of(node));
      return;
    }
    if (drawn->empty()) ++left_out.without_size;
    const Eigen::Matrix2d& linear = around.map.linear;
    if (!(std::abs(cross(linear.col(0), linear.col(1))) > kSingular * linear.squaredNorm()) && linear.allFinite()) {
      left_out.singular.add(document_.line_of(node));
      return;
    }
    for (Subpath& path : *drawn) {
      count_copies(1 + path.segments.size());
      segments_ += path.segments.size();
      if (segments_ > kMostPieces)
        document_.refuse(node, fmt::format("up to here there are more than {} segments, expected fewer", kMostPieces));
      path.start = around.map(path.start);
      for (Segment& segment : path.segments) segment = mapped(around.map, segment);
      const std::string_view id = node.attribute("id").value();
      Origin origin{std::string(document_.kind(node)), std::string(id), document_.line_of(node)};
      subpaths.push_back({std::move(path), std::move(origin), document_.offset_of(node)});
    }
  }

  /// The first child that a program without extensions draws.
  void draw_first(pugi::xml_node parent, const Surroundings& around) {
    for (const pugi::xml_node child : parent) {
      const std::string_view kind = document_.kind(child);
      if (kind.empty() || is_definition(kind) || child.attribute("requiredExtensions")) continue;
      draw(child, around);
      return;
    }
  }

  /// A viewport of an <svg> or a <symbol>, of the size that `sized` gives it.
  void enter_viewport(pugi::xml_node node, pugi::xml_node sized, Surroundings& around) const {
    const auto length = [&](pugi::xml_node from, const char* name, double fallback, double whole) {
      return length_of(document_, from, name, whole).value_or(fallback);
    };
    const double own_width = length(node, "width", around.viewport.x(), around.viewport.x());
    const double own_height = length(node, "height", around.viewport.y(), around.viewport.y());
    const Vec2 size(length(sized, "width", own_width, around.viewport.x()),
                    length(sized, "height", own_height, around.viewport.y()));
    const Vec2 corner(length(node, "x", 0, around.viewport.x()), length(node, "y", 0, around.viewport.y()));
    around.map = around.map * Affine{Eigen::Matrix2d::Identity(), corner};
    around.viewport = size;
    const std::optional<Value> written = document_.attribute(node, "viewBox");
    if (!written) return;
    const ViewBox box = parse_view_box(*written);
    if (!size.allFinite()) {
      written->refuse(written->text.data(),
                      "has a viewBox but no size, nor has the page: give it a width and a height");
    }
    around.map = around.map * fit(box, size, aspect_ratio(node));
    around.viewport = box.size;
  }

  void draw_use(pugi::xml_node node, Surroundings around) {
    const std::optional<Value> reference = reference_of(node);
    if (!reference || reference->text.empty()) {
      left_out.dangling.add(document_.line_of(node));
      return;
    }
    const auto refuse = [&](const char* why) {
      reference->refuse(reference->text.data(), fmt::format("<use> refers to '{}', {}", shown(reference->text), why));
    };
    if (reference->text.front() != '#') refuse("expected an element of this file as in '#id'");
    if (!ids_) ids_.emplace(document_.root());
    const pugi::xml_node target = ids_->find(reference->text.substr(1));
    if (!target) {
      left_out.dangling.add(document_.line_of(node));
      return;
    }
    if (std::find(uses_.begin(), uses_.end(), target) != uses_.end() || target == document_.root()) {
      refuse("which holds this very reference");
    }
    const auto shift = [&](const char* name, double whole) {
      return length_of(document_, node, name, whole).value_or(0);
    };
    const Vec2 offset(shift("x", around.viewport.x()), shift("y", around.viewport.y()));
    around.map = around.map * Affine{Eigen::Matrix2d::Identity(), offset};
    uses_.push_back(target);
    const std::string_view kind = document_.kind(target);
    if (kind == "symbol" || kind == "svg") {
      draw_symbol(node, target, around);
    } else {
      draw(target, around);
    }
    uses_.pop_back();
  }

  /// A nested <svg> is a symbol in all but that it is drawn where it stands as well.
  void draw_symbol(pugi::xml_node use, pugi::xml_node symbol, Surroundings around) {
    if (!is_displayed(symbol)) return;
    enter(symbol, around);
    enter_viewport(symbol, use, around);
    draw_children(symbol, around);
  }

  /// href, or xlink:href under whatever prefix.
  std::optional<Value> reference_of(pugi::xml_node node) const {
    if (auto own = document_.attribute(node, "href")) return own;
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (name.size() > 5 && name.substr(name.size() - 5) == ":href")
        return document_.attribute(node, attribute.name());
    }
    return std::nullopt;
  }

  void note_clipped(pugi::xml_node node) {
    const auto clips = [&](const char* name) {
      const std::string_view value = document_.property(node, name);
      return !value.empty() && value != "none";
    };
    if (clips("clip-path") || clips("mask")) ++left_out.clipped;
  }

  void note_style_sheet(pugi::xml_node node) {
    const std::string_view text = node.child_value();
    constexpr std::array<std::string_view, 3> kHiding = {"display", "visibility", "transform"};
    for (const std::string_view word : kHiding) {
      if (text.find(word) == std::string_view::npos) continue;
      ++left_out.style_sheets;
      return;
    }
  }

  const Document& document_;
  std::optional<Ids> ids_;
  std::vector<pugi::xml_node> uses_;  // what the uses around refer to, outermost first
  std::size_t copies_ = 0;
  std::size_t segments_ = 0;
};

}  // namespace

Drawing parse_svg(std::string_view text, const std::string& name) {
  const Document document(text, name);
  Walker walker(document);
  walker.draw_root();
  Curves curves = to_curves(std::move(walker.subpaths), document.text());
  walker.left_out.without_length = curves.without_length;
  return {name, walker.unit, std::move(curves.curves), walker.left_out.notes()};
}

}  // namespace rollfix::files
