#pragma once

// Parts from files, and answers as the JSON documents that the program prints with --json (docs/json.md lists their
// fields). Lengths of a drawing are in its unit, or in the one that is asked for.
//
//     const LoadedPart loaded = load_part("examples/bracket.dxf", {.loop = 1});
//     loaded.unit;                                  // "mm"
//     loaded.loops.size();                          // 2
//     std::round(10 * loaded.part.perimeter()) / 10;  // 252.5
//
//     const Answer answer = solve({load_part("gallery:ellipse,a=2,b=1"), Reading(1.0, 0.5)});
//     const std::string text = format_answer(answer, Layout::line);
//     text.find("rollfix/locate/1") != std::string::npos;  // true
//
// Degenerate cases: open chains, gaps, loops within loops, curves that cross: each is joined, chosen or refused, and
// `notes` or the error says which and where (docs/files.md).
//
// Accuracy: curves are kept as drawn, arcs as arcs and splines as splines; a saved part answers with the same bits as
// the one that was saved. Documents have as many digits as bring each bit back; what is not known is null.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// How to take what the user names. What does not apply to the kind of file is refused, never ignored.
struct LoadOptions {
  OutlineOptions points;            // `open` and `unit` are for drawings as well: the longest open chain
  std::optional<std::size_t> loop;  // of a drawing, counted from 1 as in LoadedPart::loops
  std::optional<Length> gap;        // of a drawing: ends this close together meet; default see LoopOptions
  bool outer = false;               // of a drawing: where more than two ends meet, what is around the outside
  std::string layer;                // of a DXF: only this one
  bool allow_crossing = false;      // see PartOptions
  bool saved_name = false;          // a saved part is called as it was when it was saved, not as its file
};

/// A part with what its file said besides. Its unit is that of the options: where the file states another, the part is
/// converted; where it states none (points without a unit in their header, the pixels of an SVG, the gallery) the
/// numbers are taken to be in it.
struct LoadedPart {
  Part part;
  std::string unit;         // of all lengths: "mm", "in", ...; empty where neither the file nor the options say
  std::vector<Loop> loops;  // of a drawing: the closed ones by falling area, then the open ones by falling length
  std::size_t loop = 0;     // the one that was taken, counted from 1; 0: not a drawing
  std::vector<std::string> notes;  // all that was left out, joined or chosen: for the user to read
};

/// The part that the user calls by this argument, which becomes its name: "gallery:NAME,key=value,...", a file by its
/// ending (.csv .dat .txt points, .dxf, .svg, .json a gallery shape, curves or a saved part), or "-" for standard
/// input, known by how it begins. Throws InputError: what the parts throw, an ending that is not known, an option that
/// does not apply, or a drawing without a closed loop (with the size and the place of the gap). Options are always
/// given, mostly as {}: load_part(argument) is the core's, which takes the gallery and points only.
LoadedPart load_part(const std::string& argument, const LoadOptions& options);

/// The part through the points of such a text, which messages call by this name. Throws InputError as load_part does.
LoadedPart load_points(std::string text, const std::string& name, const LoadOptions& options);

/// A part that is there, as if it had been saved and loaded: converted to the unit of the options.
LoadedPart loaded_part(const Part& part, const LoadOptions& options);

/// A part's outline as the text of a file: JSON whose numbers are kept bit by bit, with a version and a checksum.
/// Throws InputError when the outline has curves of a type that can't be saved (one of the user's own, without
/// `record()`).
std::string format_part(const Part& part);

/// The part of such a text: it answers every question with the same bits as the one that was saved. `name` is what
/// messages call the text and becomes the part's name. Throws InputError: not such a text, of another version, or
/// changed since it was written.
Part parse_part(std::string_view text, const std::string& name);

/// Whether a JSON text says of itself, in its first field, that it is a saved part of whatever version.
bool is_saved_part(std::string_view text);

/// What the part of such a text, of one that parse_part takes, was called when it was saved.
std::string saved_name(std::string_view text);

/// Writes format_part to a file. Throws InputError also when it can't be written.
void save_part(const Part& part, const std::string& path);

// What is answered, as text. The types are in the headers of the questions: rollfix/solve.hpp, rollfix/touch.hpp, ...

struct Answer;
struct Certificate;
struct HoldAnswer;
struct HoldCertificate;
struct HoldDiagnosis;
struct HoldProblem;
struct Inspection;
struct NextPin;
struct NextRoll;
struct NextTouch;
struct PairCertificate;
struct Plan;
struct PlanProblem;
class Solution;
struct Taught;
struct TouchAnswer;
struct TouchCertificate;
struct TouchDiagnosis;

/// How a document is laid out: a field on each line, or all of it on one.
enum class Layout { lines, line };

/// "rollfix/locate/1". `explain`: with what the fingers can't do.
std::string format_answer(const Answer& answer, Layout layout = Layout::lines, bool explain = false);

/// "rollfix/certificate/1".
std::string format_certificate(const Certificate& certificate);

/// "rollfix/pair-certificate/1".
std::string format_certificate(const PairCertificate& certificate);

/// "rollfix/touch-certificate/1".
std::string format_certificate(const TouchCertificate& certificate);

/// "rollfix/hold-certificate/1".
std::string format_certificate(const HoldCertificate& certificate);

/// "rollfix/inspect/1" of the part of `loaded`, with the loops of its drawing.
std::string format_inspection(const Inspection& inspection, const LoadedPart& loaded, Layout layout = Layout::lines);

/// "rollfix/advise/1".
std::string format_next_roll(const NextRoll& next, Layout layout = Layout::lines);

/// "rollfix/teach/1": the inspection of the part that was taught, and how it was.
std::string format_taught(const Inspection& inspection, const Taught& taught, Layout layout = Layout::lines);

/// "rollfix/locate/1" of touches.
std::string format_touches(const TouchAnswer& answer, Layout layout = Layout::lines);

/// "rollfix/advise/1" of touches.
std::string format_next_touch(const TouchAnswer& answer, const NextTouch& next, Layout layout = Layout::lines);

/// "rollfix/locate/1" of three and more fingers.
std::string format_hold(const HoldAnswer& answer, Layout layout = Layout::lines);

/// "rollfix/advise/1" of how a wheel's pin moves next.
std::string format_next_pin(const HoldAnswer& held, const NextPin& next, Layout layout = Layout::lines);

/// A certificate's document, whether it proves everything, and if not what in it says where it does not.
struct CertificateText {
  std::string text;
  bool complete = true;
  std::string where;
};

/// The certificate of an answer, searched again with its tolerance and this budget; of one to a roll without its noise,
/// the part face up and one way round, so that others are to be refused beforehand. Throws InputError: as `certify`,
/// `certify_pair`, `certify_touches` and `certify_holds`.
CertificateText certificate_of(const Answer& answer, std::optional<std::size_t> budget = {});
CertificateText certificate_of(const TouchAnswer& answer, std::optional<std::size_t> budget = {});
CertificateText certificate_of(const HoldProblem& problem, const HoldAnswer& answer);

/// What to know about how a roll was understood, a sentence each: rows on corners of a finger, a way round that can't
/// be, lengths that changed their signs.
std::vector<std::string> notes_of(const Answer& answer);

/// What is wrong, and what to give instead, in plain English.
std::string words_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer);
std::string cure_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer);
/// Both in one, of touches and of rolls on a part at rest.
std::string words_of(const TouchDiagnosis& diagnosis, const TouchAnswer& answer);

/// "rollfix/locate/1" of whichever kind. `explain`: of one roll, with what the fingers can't do.
std::string format_solution(const Solution& solution, Layout layout = Layout::lines, bool explain = false);

/// "rollfix/plan/1".
std::string format_plan_document(const Plan& plan, const PlanProblem& problem, Layout layout = Layout::lines);

}  // namespace rollfix
