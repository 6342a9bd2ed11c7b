#include "rollfix/files.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>
#include <variant>

#include "files/formats.hpp"
#include "files/point_notes.hpp"
#include "outline/refusals.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"
#include "text/units.hpp"
#include "work/pulse.hpp"

namespace rollfix {

namespace {

/// What a user can name as a part.
enum class FileKind { gallery, points, dxf, svg, json, saved_part };

constexpr const char* kKnown =
    "points in .csv, .dat or .txt, a drawing in .dxf or .svg, a shape or a saved part in .json, or gallery:NAME as in "
    "gallery:ellipse,a=2,b=1";

constexpr std::string_view kBinaryDxf = "AutoCAD Binary DXF";

FileKind kind_by_beginning(std::string_view text) {
  if (text.substr(0, kBinaryDxf.size()) == kBinaryDxf) return FileKind::dxf;
  text = without_mark(text);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return FileKind::points;
  if (text[first] == '<') return FileKind::svg;
  if (text[first] == '{') return FileKind::json;
  // An ASCII DXF begins with a group code, alone on its line, and SECTION; or with a 999 comment.
  const std::size_t line_end = text.find_first_of("\r\n", first);
  const std::string_view code = text.substr(first, line_end == std::string_view::npos ? line_end : line_end - first);
  const std::string_view head = text.substr(0, 4096);
  const bool is_code = code == "0" || code == "999";
  return is_code && head.find("SECTION") != std::string_view::npos ? FileKind::dxf : FileKind::points;
}

/// By "gallery:" or the ending of the file's name; standard input ("-") counts as points until it is read.
/// Throws InputError for any other ending.
FileKind kind_by_name(const std::string& argument) {
  if (argument.rfind("gallery:", 0) == 0) return FileKind::gallery;
  if (argument == "-") return FileKind::points;
  const std::string ending = ending_of(argument);
  if (ending == ".csv" || ending == ".dat" || ending == ".txt") return FileKind::points;
  if (ending == ".dxf") return FileKind::dxf;
  if (ending == ".svg") return FileKind::svg;
  if (ending == ".json") return FileKind::json;
  throw InputError(unknown_ending(argument, kKnown));
}

/// The same once the content is known: of standard input by how it begins, and whether a .json is a saved part.
FileKind kind_by_content(FileKind by_name, bool is_standard_input, std::string_view text) {
  const FileKind kind = is_standard_input ? kind_by_beginning(text) : by_name;
  return kind == FileKind::json && is_saved_part(text) ? FileKind::saved_part : kind;
}

constexpr const char* kStandardInput = "standard input";

std::string place(const Vec2& point) { return shown_point(point.x(), point.y()); }

/// The options that were given, by what they apply to.
struct Given {
  std::string for_points;    // the first option for points only
  std::string for_drawings;  // for drawings only
  bool open = false;
  bool layer = false;

  explicit Given(const LoadOptions& options) : open(options.points.open), layer(!options.layer.empty()) {
    if (options.points.corner_angle) for_points = "`corner_angle`";
    if (options.points.smooth) for_points = "`smooth`";
    if (options.loop) for_drawings = "`loop`";
    if (options.gap) for_drawings = "`gap`";
    if (options.outer) for_drawings = "`outer`";
    if (layer) for_drawings = "`layer`";
  }
};

void refuse(const std::string& option, const char* what_for, const std::string& name, const char* what_it_is) {
  if (option.empty()) return;
  throw InputError(fmt::format("{} is for {}, and {} is {}: leave the option out", option, what_for, name, what_it_is));
}

void require_options_for(FileKind kind, const std::string& name, const LoadOptions& options) {
  const Given given(options);
  switch (kind) {
    case FileKind::gallery:
      refuse(given.for_points, "points", name, "a gallery shape");
      refuse(given.for_drawings, "drawings", name, "a gallery shape");
      refuse(given.open ? "`open`" : "", "points and drawings", name, "a gallery shape");
      break;
    case FileKind::points:
      refuse(given.for_drawings, "drawings", name, "points");
      break;
    case FileKind::dxf:
      break;
    case FileKind::svg:
    case FileKind::json:
      refuse(given.layer ? "`layer`" : "", "DXF files", name, "none");
      break;
    case FileKind::saved_part:
      refuse(given.for_points, "points", name, "a saved part");
      refuse(given.for_drawings, "drawings", name, "a saved part");
      refuse(given.open ? "`open`" : "", "points and drawings", name, "a saved part");
      break;
  }
}

LoadedPart of_outline(Outline outline, const LoadOptions& options) {
  std::string unit = outline.unit;
  return {Part(std::move(outline), {options.allow_crossing}), std::move(unit), {}, 0, {}};
}

/// Pixels are no length: what a drawing in them measures, nobody said.
constexpr const char* kPixels = "px";

bool states_a_length(const std::string& unit) { return !unit.empty() && unit != kPixels; }

/// The unit that a file's lengths come out in, and how.
struct Unified {
  std::string unit;
  double factor = 1;
};

Unified unified(const std::string& name, const std::string& stated, const std::string& wanted,
                std::vector<std::string>& notes) {
  if (wanted.empty() || wanted == stated) return {stated, 1};
  if (!states_a_length(stated)) {
    if (!stated.empty()) notes.push_back(fmt::format("its lengths, {}, are taken as {}", stated, wanted));
    return {wanted, 1};
  }
  const double factor = length_conversion(stated, wanted, name)(1);
  notes.push_back(fmt::format("converted from {} to {}", stated, wanted));
  return {wanted, factor};
}

/// Throws InputError: a unit that is not one of length.
LoadOptions with_known_unit(const LoadOptions& options) {
  LoadOptions result = options;
  if (options.points.unit.empty()) return result;
  const std::optional<Unit> unit = unit_named(options.points.unit);
  if (!unit || unit->dimension != Dimension::length) {
    throw InputError(
        fmt::format("`unit` {}: expected a unit of length: {}", options.points.unit, unit_names(Dimension::length)));
  }
  result.points.unit = unit->name;
  return result;
}

[[noreturn]] void refuse_open(const std::string& name, const Loop& longest) {
  const Vec2 start = longest.outline.curves.front().front();
  const Vec2 end = longest.outline.curves.back().back();
  const double gap = (end - start).norm();
  throw InputError(fmt::format(
      "{}: expected a closed loop, found none: the longest chain ({}, length {:.6g}) is open by {:.6g} "
      "between {} and {}: close it in the drawing, let ends that far apart meet with `gap`, or take it as "
      "it is with `open`",
      name, counted(longest.outline.curves.size(), "curve", "curves"), longest.length, gap, place(end), place(start)));
}

/// Which loop to take, counted from 0.
std::size_t choice(const std::string& name, const Loops& found, const LoadOptions& options) {
  const std::size_t count = found.closed.size() + found.open.size();
  if (options.loop) {
    if (*options.loop >= 1 && *options.loop <= count) return *options.loop - 1;
    throw InputError(fmt::format("`loop` {}: {} has {}: expected a number from 1 to {}", *options.loop, name,
                                 counted(count, "loop", "loops"), count));
  }
  if (options.points.open) {
    if (!found.open.empty()) return found.closed.size();
    throw InputError(fmt::format(
        "{}: `open` expects a chain of curves with two ends, found closed loops only: leave the option out", name));
  }
  if (found.closed.empty()) refuse_open(name, found.open.front());
  if (!found.doubt.empty()) throw InputError(found.doubt);
  return 0;
}

std::vector<std::string> notes_on(const Drawing& drawing, const Loops& found, std::size_t chosen, const Loop& loop,
                                  const LoadOptions& options) {
  std::vector<std::string> notes;
  const auto add = [&](const std::string& note) { notes.push_back(fmt::format("{}: {}", drawing.name, note)); };
  for (const std::string& note : drawing.notes) add(note);
  for (const std::string& note : found.notes) add(note);
  const bool is_choice = found.closed.size() + found.open.size() > 1;
  if (is_choice && !options.loop) {
    std::vector<std::string> kinds;
    if (!found.closed.empty()) kinds.push_back(counted(found.closed.size(), "closed loop", "closed loops"));
    if (!found.open.empty()) kinds.push_back(counted(found.open.size(), "open chain", "open chains"));
    add(fmt::format("{}: took number {}, the {}; `loop` N takes another", fmt::join(kinds, " and "), chosen + 1,
                    loop.outline.closed ? "largest loop" : "longest chain"));
  }
  if (loop.has_gap()) {
    add(fmt::format("ends of curves up to {:.3g} apart were taken to meet (`gap`)", loop.gap));
  }
  if (!loop.outline.closed && !options.points.open) add("the loop taken is open: a curve with two ends");
  return notes;
}

/// The ends of a loop's lines as points of a scan, to be smoothed.
Outline smoothed(const Loop& loop, const std::string& name, const LoadOptions& options, const std::string& unit,
                 std::vector<std::string>& notes) {
  std::vector<Vec2> points;
  for (const Curve& curve : loop.outline.curves) {
    const std::optional<CurveRecord> record = curve.record();
    const bool is_line = record && record->kind.find("line") != std::string::npos;
    if (!is_line) {
      throw InputError(fmt::format(
          "{}: `smooth` is for points and for loops of straight lines, and this one has curves: leave the option out",
          name));
    }
    points.push_back(curve.front());
  }
  OutlineOptions as_points = options.points;
  as_points.open = !loop.outline.closed;
  as_points.unit = unit;
  if (as_points.open) points.push_back(loop.outline.curves.back().back());
  Outline outline = outline_through(points, name, as_points, &notes);
  outline.hole = loop.outline.hole;
  return outline;
}

LoadedPart of_drawing(Drawing drawing, const LoadOptions& options) {
  const auto [unit, factor] = unified(drawing.name, drawing.unit, options.points.unit, drawing.notes);
  if (factor != 1) {
    for (DrawnCurve& one : drawing.curves) one.curve = scaled(one.curve, factor);
  }
  LoopOptions joining;
  if (options.gap) {
    joining.gap = in_unit(*options.gap, states_a_length(unit) ? unit : "", "`gap`");
    if (!(*joining.gap >= 0))
      throw InputError(fmt::format("`gap`: expected a length of at least 0, found {}", *joining.gap));
  }
  joining.outer = options.outer;
  Loops found = loops(drawing, joining);
  drawing.curves = std::vector<DrawnCurve>();  // what follows takes memory
  for (std::vector<Loop>* some : {&found.closed, &found.open}) {
    for (Loop& loop : *some) loop.outline.unit = unit;
  }
  const std::size_t chosen = choice(drawing.name, found, options);
  const std::size_t closed = found.closed.size();
  std::vector<std::string> notes =
      notes_on(drawing, found, chosen, chosen < closed ? found.closed[chosen] : found.open[chosen - closed], options);
  std::vector<Loop> all = std::move(found.closed);
  std::move(found.open.begin(), found.open.end(), std::back_inserter(all));
  const bool corner_angle_alone = !options.points.smooth && options.points.corner_angle.has_value();
  refuse(corner_angle_alone ? "`corner_angle`" : "", "points", drawing.name, "a drawing");
  Outline outline =
      options.points.smooth ? smoothed(all[chosen], drawing.name, options, unit, notes) : all[chosen].outline;
  Part part(std::move(outline), {options.allow_crossing});
  return {std::move(part), unit, std::move(all), chosen + 1, std::move(notes)};
}

LoadedPart of_json(const std::string& text, const std::string& name, const LoadOptions& options) {
  std::variant<Outline, Drawing> content = files::parse_json_outline(text, name);
  if (Drawing* drawing = std::get_if<Drawing>(&content)) {
    require_options_for(FileKind::json, name, options);
    return of_drawing(std::move(*drawing), options);
  }
  require_options_for(FileKind::gallery, name, options);
  auto& outline = std::get<Outline>(content);
  outline.unit = options.points.unit;
  return of_outline(std::move(outline), options);
}

}  // namespace

LoadedPart load_points(std::string text, const std::string& name, const LoadOptions& options) {
  std::vector<std::string> notes;
  OutlineOptions known = options.points;
  const std::vector<Vec2> points = parse_points(text, name, options.points, &notes, &known.unit, &known.airfoil);
  std::string().swap(text);  // what follows takes memory
  Outline outline = outline_through(points, name, known, &notes);
  LoadedPart loaded = [&] {
    try {
      return of_outline(std::move(outline), options);
    } catch (const InputError& error) {
      const std::string message = error.what();
      const bool crosses = message.find("`allow_crossing`") != std::string::npos;
      throw InputError(message + (crosses ? files::noisy_crossing_hint(points, known) : ""));
    }
  }();
  for (const std::string& note :
       {files::sparse_corners_note(points, known, loaded.part), files::rounded_corners_note(points, known, loaded.part),
        files::noisy_points_note(points, known, loaded.part)}) {
    if (!note.empty()) notes.push_back(note);
  }
  loaded.notes = std::move(notes);
  return loaded;
}

namespace {

/// What was saved stays, to the bit, unless it is to be in another unit.
LoadedPart in_unit_asked_for(Part part, const std::string& name, const LoadOptions& options) {
  std::vector<std::string> notes;
  const auto [unit, factor] = unified(name, part.unit(), options.points.unit, notes);
  if (unit != part.unit()) {
    const PartOptions as_it_is{true};  // whoever saved it allowed what there is
    part = factor == 1 ? with_unit(part, unit) : Part(scaled(part.outline(), factor, unit), as_it_is);
  }
  for (std::string& note : notes) note.insert(0, name + ": ");
  return {std::move(part), unit, {}, 0, std::move(notes)};
}

LoadedPart of_saved_part(const std::string& text, const std::string& name, const LoadOptions& options) {
  const Part part = parse_part(text, name);
  const std::string saved = options.saved_name ? saved_name(text) : "";
  return in_unit_asked_for(saved.empty() ? part : with_name(part, saved), name, options);
}

LoadedPart of_file(FileKind kind, std::string text, const std::string& name, const LoadOptions& options) {
  switch (kind) {
    case FileKind::dxf:
    case FileKind::svg: {
      Drawing drawing =
          kind == FileKind::dxf ? files::parse_dxf(text, name, {options.layer}) : files::parse_svg(text, name);
      std::string().swap(text);  // what follows takes memory
      return of_drawing(std::move(drawing), options);
    }
    case FileKind::saved_part:
      return of_saved_part(text, name, options);
    case FileKind::json:
      return of_json(text, name, options);
    case FileKind::gallery:  // is no file
    case FileKind::points:
      break;
  }
  return load_points(std::move(text), name, options);
}

}  // namespace

LoadedPart load_part(const std::string& argument, const LoadOptions& options) {
  const LoadOptions known = with_known_unit(options);
  const std::string name = argument == "-" ? kStandardInput : argument;
  const Doing doing("reading the outline");
  try {
    const FileKind by_name = kind_by_name(argument);
    if (by_name == FileKind::gallery) {
      require_options_for(by_name, name, known);
      Outline outline = load_outline(argument);
      outline.unit = known.points.unit;
      return of_outline(std::move(outline), known);
    }
    std::string text = read_text(argument);
    const FileKind kind = kind_by_content(by_name, argument == "-", text);
    if (kind != FileKind::json) require_options_for(kind, name, known);
    return of_file(kind, std::move(text), name, known);
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool named = argument.rfind("gallery:", 0) == 0 || message.find(name) != std::string::npos;
    throw InputError(named ? message : fmt::format("{}: {}", name, message));
  }
}

LoadedPart loaded_part(const Part& part, const LoadOptions& options) {
  return in_unit_asked_for(part, part.name(), options);
}

}  // namespace rollfix
