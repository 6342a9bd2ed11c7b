#pragma once

#include <optional>
#include <string>
#include <vector>

#include "documents/json_output.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/files.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/part.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/teach.hpp"
#include "rollfix/touch.hpp"

// The documents of docs/json.md, and the pieces that several of them share.
namespace rollfix {

template <class Entries, class ToJson>
Json json_list(const Entries& entries, const ToJson& to_json) {
  Json list = Json::array();
  for (const auto& entry : entries) list.push_back(to_json(entry));
  return list;
}

/// A list of rows.
template <class Matrix>
Json matrix_json(const Matrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(json_numbers(matrix.row(i)));
  return rows;
}

inline std::string formatted(const Json& document, Layout layout) {
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

/// "rollfix/locate/1". `explain`: with what the fingers can't do.
Json answer_document(const Answer& answer, bool explain);
Json touches_document(const TouchAnswer& answer);
Json hold_document(const HoldAnswer& answer);
Json solution_document(const Solution& solution, bool explain);

/// "rollfix/advise/1" of touches.
Json next_touch_document(const TouchAnswer& answer, const NextTouch& next);

/// "rollfix/inspect/1" of a part that was not drawn: without loops.
Json inspection_json(const Inspection& inspection);
/// Its field `loops`: all that a drawing holds.
Json loops_json(const LoadedPart& loaded);

/// A number of one finger, a list of two.
Json per_finger_json(const PerFinger<double>& values);
/// Of one part or of several: `of` says which.
Json advice_json(const std::string& verdict, const Json& of, const std::optional<Advice>& advice,
                 const std::string& why, const Json& hypotheses);

/// The field `taught` of "rollfix/teach/1".
Json taught_json(const Taught& taught);

/// What would have to be otherwise for something to fit; empty where something does.
std::string about(const Diagnosis& diagnosis);
const char* name_of(Cause cause);
/// What to give instead, with these fingers and this noise as given.
std::string cure_of(const Diagnosis& diagnosis, const std::vector<Finger>& fingers, const Noise& said);

/// As it is typed: "--noise contact=0.05,angle=0.2deg".
std::string noise_option(const Noise& noise);

/// What was done about a taught course's ends, in one word.
const char* name_of(Closing closing);

/// "disk,r=0.1", "jaw", or the outline's name.
std::string name_of(const Finger& finger);

/// One of "placements"; of the answer it takes how many fingers there are, and what is known with them.
Json placement_json(const Placement& placement, const Answer& answer);
Json readings_json(const Answer& answer);
/// "placements", "touches" and "clear" of an answer to touches.
Json pose_sets_json(const TouchAnswer& answer);
Json touches_json(const std::vector<MeasuredTouch>& touches, const std::vector<TouchTolerance>& tolerance);
Json clear_json(const std::vector<Clear>& paths);
Json point_json(const Vec2& point);
Json pose_json(const Pose& pose);  // [x, y, heading]
Json part_json(const Part& part);
/// Null where the rows fit. `fingers` and `noise` as given, for the cure.
Json diagnoses_json(const std::vector<Diagnosis>& diagnoses, const std::vector<Finger>& fingers, const Noise& noise);
Json noise_json(const Noise& noise);
Json prior_json(const std::optional<Prior>& prior);  // [s, sd], null without
/// Null without; x and y are null where only the heading is known.
Json pose_prior_json(const std::optional<PosePrior>& prior);
Json accuracy_json(const Accuracy& accuracy);  // null where it is exact

/// The boundary as samples_of gives it, as CSV with a line of titles: s,x,y,tangent,curvature, lengths with the part's
/// unit behind them as in x [mm]; the tangent in radians.
/// Numbers read back as the same doubles.
std::string outline_table(const Part& part);

/// The same as JSON: a list for each of these names.
Json outline_json(const Part& part);

}  // namespace rollfix
