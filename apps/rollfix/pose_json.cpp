#include "rollfix/pose_json.hpp"

#include <algorithm>
#include <vector>

namespace rollfix::app {
namespace {

Json largest(const std::vector<double>& values) {
  return values.empty() ? Json(nullptr) : json_number(*std::max_element(values.begin(), values.end()));
}

}  // namespace

Json pose_json(const std::optional<Poses>& poses) {
  if (!poses) return nullptr;
  Json list = Json::array();
  for (const Pose& pose : poses->pose) {
    list.push_back(Json::array({json_number(pose.x), json_number(pose.y), json_number(pose.heading)}));
  }
  return list;
}

Json pose_residual_json(const std::optional<Poses>& poses) {
  if (!poses) return nullptr;
  return {{"length", largest(poses->residual)}, {"turn", largest(poses->turn_residual)}};
}

}  // namespace rollfix::app
