#include "rollfix/weighing.hpp"

#include <fmt/format.h>

#include "rollfix/error.hpp"
#include "rollfix/noise_argument.hpp"
#include "rollfix/table.hpp"
#include "rollfix/typed_number.hpp"
#include "rollfix/usage.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

Prior read_prior(const std::string& text) {
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 2) {
    throw InputError(
        fmt::format("--prior {}: expected S,SD: about where the finger started, along the stored outline, and its "
                    "standard deviation",
                    text));
  }
  const std::string what = "--prior " + text;
  const Prior prior{read_number(fields[0], what), read_number(fields[1], what)};
  if (!(prior.sd > 0))
    throw InputError(fmt::format("{}: '{}' is not above 0, expected a standard deviation", what, fields[1]));
  return prior;
}

const char* name_of(Cause cause) {
  switch (cause) {
    case Cause::none:
      break;
    case Cause::radius:
      return "radius";
    case Cause::slip:
      return "slip";
    case Cause::part:
      return "part";
  }
  return "none";
}

Json matrix_json(const Eigen::Matrix3d& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) {
    rows.push_back(Json::array({json_number(matrix(i, 0)), json_number(matrix(i, 1)), json_number(matrix(i, 2))}));
  }
  return rows;
}

}  // namespace

std::string about(const Diagnosis& diagnosis) {
  switch (diagnosis.cause) {
    case Cause::none:
      break;
    case Cause::radius:
      return fmt::format(
          "it would if all lengths were {:.4g} times as long: likeliest is a wrong radius of the finger, or a wrong "
          "unit",
          diagnosis.length_scale);
    case Cause::slip:
      return "it would if lengths were off here and there: likeliest is that the finger slipped";
    case Cause::part:
      return "neither other lengths nor slip explain it: likeliest is another part, another side of it, or wrong signs";
  }
  return "";
}

Json diagnosis_json(const Diagnosis& diagnosis) {
  if (diagnosis.cause == Cause::none) return nullptr;
  return {{"cause", name_of(diagnosis.cause)},
          {"length_scale", json_number(diagnosis.length_scale)},
          {"excess", json_number(diagnosis.excess)}};
}

Json noise_json(const Noise& noise) {
  return {{"contact", json_number(noise.contact)},
          {"angle", json_number(noise.angle)},
          {"slip", json_number(noise.slip)},
          {"radius", json_number(noise.radius)}};
}

void add_noise_arguments(CLI::App& command, NoiseArguments& arguments) {
  add_noise_argument(command, arguments.noise);
  command
      .add_option("--prior", arguments.prior,
                  "with --noise: about where the finger started, along the stored outline, and how sure that is")
      ->type_name("S,SD");
  add_switch(command, "--robust", arguments.robust, "with --noise: stray rows don't count");
}

std::optional<BeliefOptions> read_belief_options(const NoiseArguments& arguments) {
  const std::optional<Noise> noise = read_noise(arguments.noise);
  if (!noise) {
    if (!arguments.prior.empty())
      throw InputError("--prior weighs places against noisy readings: give --noise as well");
    if (arguments.robust) throw InputError("--robust is about noise: give --noise as well");
    return std::nullopt;
  }
  BeliefOptions options;
  options.noise = *noise;
  options.robust = arguments.robust;
  if (!arguments.prior.empty()) options.prior = read_prior(arguments.prior);
  return options;
}

void add_weight(const Weighing& weighing, std::size_t k, Json& placement) {
  const Mode& mode = weighing.modes[k];
  placement["probability"] = json_number(mode.probability);
  placement["mean"] = Json::array({json_number(mode.mean)});
  placement["sd"] = Json::array({json_number(mode.sd)});
  placement["interval"] = Json::array({json_interval(mode.interval)});
  placement["end_mean"] = Json::array({json_number(mode.end_mean)});
  placement["end_sd"] = Json::array({json_number(mode.end_sd)});
  const std::optional<PoseSpread>& pose = weighing.poses[k];
  placement["pose_mean"] =
      pose ? Json::array({json_number(pose->mean.x), json_number(pose->mean.y), json_number(pose->mean.heading)})
           : Json(nullptr);
  placement["pose_covariance"] = pose ? matrix_json(pose->covariance) : Json(nullptr);
}

void add_weighing(const Weighing& weighing, Json& document) {
  document["noise"] = noise_json(weighing.options.noise);
  document["prior"] =
      weighing.options.prior
          ? Json::array({json_number(weighing.options.prior->s), json_number(weighing.options.prior->sd)})
          : Json(nullptr);
  document["robust"] = weighing.options.robust;
  document["samples"] = weighing.samples;
  document["excess"] = json_number(weighing.excess);
  document["rest"] = json_number(weighing.rest);
  document["diagnosis"] = diagnosis_json(weighing.diagnosis);
}

std::string weighing_lines(const Weighing& weighing) {
  const Noise& noise = weighing.options.noise;
  std::string text =
      fmt::format("noise      contact {:.4g}, angle {} deg, slip {:.4g}, radius {:.4g}{}\n", noise.contact,
                  degrees(noise.angle), noise.slip, noise.radius, weighing.options.robust ? "; robust" : "");
  if (weighing.options.prior) {
    text += fmt::format("prior      s = {:.6g}, sd {:.4g}\n", weighing.options.prior->s, weighing.options.prior->sd);
  }
  text += fmt::format("samples    {}", weighing.samples);
  if (weighing.excess > 1) text += fmt::format("; off by {:.2f} times the noise, widened by that", weighing.excess);
  text += '\n';
  if (!weighing.improbable.empty()) {
    text += fmt::format("dropped    {} that the readings alone allow, but not all samples together\n",
                        weighing.improbable.size());
  }
  return text;
}

std::string advice(const Weighing& weighing) {
  const std::string& verdict = weighing.verdict;
  if (weighing.diagnosis.cause != Cause::none)
    return fmt::format("{}: nothing fits; {}", verdict, about(weighing.diagnosis));
  if (weighing.modes.empty()) return verdict + ": nothing that fits is within the finger's reach";
  const Mode& first = weighing.modes.front();
  const std::string where = fmt::format("s = {:.6g}, sd {:.2g}", first.start, first.sd);
  if (verdict == "unique") return fmt::format("{}: the finger started at {}", verdict, where);
  if (verdict == "unobservable") return verdict + ": this roll looks the same from every place on the boundary";
  if (weighing.modes.size() == 1 || verdict.find("stretch") != std::string::npos) {
    return fmt::format("{}: the likeliest start is {}; roll on to know it better", verdict, where);
  }
  return fmt::format("{}: the likeliest start is {}, with probability {:.2f}; roll on to tell them apart", verdict,
                     where, first.probability);
}

}  // namespace rollfix::app
