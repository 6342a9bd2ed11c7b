#include "rollfix/pair_weighing.hpp"

#include <fmt/format.h>

#include "rollfix/json_output.hpp"

namespace rollfix::app {
namespace {

template <class Matrix>
Json rows_json(const Matrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(json_number(matrix(i, j)));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

void add_weight(const PairWeighing& weighing, std::size_t k, Json& placement) {
  const PairMode& mode = weighing.modes[k];
  placement["probability"] = json_number(mode.probability);
  placement["mean"] = json_numbers(mode.mean);
  placement["sd"] = json_numbers(mode.sd);
  placement["covariance"] = rows_json(mode.covariance);
  placement["interval"] = Json::array({json_interval(mode.interval[0]), json_interval(mode.interval[1])});
  placement["end_mean"] = json_numbers(mode.end_mean);
  placement["end_sd"] = json_numbers(mode.end_sd);
  const std::optional<PoseSpread>& pose = weighing.common.poses[k];
  placement["pose_mean"] =
      pose ? Json::array({json_number(pose->mean.x), json_number(pose->mean.y), json_number(pose->mean.heading)})
           : Json(nullptr);
  placement["pose_covariance"] = pose ? rows_json(pose->covariance) : Json(nullptr);
}

void add_weighing(const PairWeighing& weighing, Json& document) {
  add_weighing(weighing.common, document);
  document["dropped"]["improbable"] = weighing.improbable.size();
}

std::string weighing_lines(const PairWeighing& weighing) {
  std::string text = weighing_lines(weighing.common);
  if (!weighing.improbable.empty()) {
    text += fmt::format("dropped    {} within the tolerance for the readings, but not for all samples\n",
                        weighing.improbable.size());
  }
  return text;
}

std::string advice(const PairWeighing& weighing) {
  const std::string& verdict = weighing.common.verdict;
  if (weighing.common.diagnosis.cause != Cause::none || weighing.modes.empty()) return advice(weighing.common);
  const PairMode& first = weighing.modes.front();
  const std::string where = fmt::format("finger a at s = {:.6g}, sd {:.2g}, finger b at {:.6g}, sd {:.2g}",
                                        first.start[0], first.sd[0], first.start[1], first.sd[1]);
  if (verdict == "unobservable") {
    return verdict + ": pairs all the way round the boundary fit; no such roll, however long, can tell them apart";
  }
  if (verdict == "unique") return fmt::format("{}: the roll started with {}", verdict, where);
  return fmt::format("{}: the likeliest start is {}, with probability {:.2f}; roll on to tell them apart", verdict,
                     where, first.probability);
}

}  // namespace rollfix::app
