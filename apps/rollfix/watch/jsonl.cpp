// What a watch prints for programs.
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "catalog/identify_json.hpp"
#include "documents/documents.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/watch/writer.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kSchema = "rollfix/watch/1";

// In the order of RollEnd and of WatchEnd.
constexpr std::array kWhyOver = {"lost", "jump", "restarted", "ended", "elsewhere"};
constexpr std::array kWhyEnd = {"stream", "signal", "idle"};

Json mode_json(const Mode& mode, const Part& part) {
  const auto point = [&](double s) { return point_json(part.point(s)); };
  const auto direction = [](double angle) { return json_number(std::remainder(angle, 2 * std::numbers::pi)); };
  Json json = {{"start", json_numbers(mode.start)},
               {"end", json_numbers(mode.end)},
               {"probability", json_number(mode.probability)},
               {"mean", json_numbers(mode.mean)},
               {"sd", json_numbers(mode.sd)},
               {"interval", json_list(mode.interval, json_interval)},
               {"end_mean", json_numbers(mode.end_mean)},
               {"end_sd", json_numbers(mode.end_sd)},
               {"point", json_list(mode.start, point)},
               {"tangent", json_list(mode.tangent, direction)}};
  if (mode.start.size() == 2) json["covariance"] = matrix_json(mode.covariance);
  return json;
}

/// The parts that remain, as identify lists them.
void add_parts(const Tracked& answer, const Catalog& catalog, Json& event) {
  const Json document = identified_document(catalog, *answer.parts);
  event["verdict"] = answer.parts->verdict;
  event["left"] = answer.parts->left.size();
  event["parts"] = answer.parts->counted ? Json(nullptr) : document["parts"];
  event["rest"] = answer.parts->counted ? Json(nullptr) : document["rest"];
}

/// Beside a wheel, as `locate` has it.
void add_held(const HoldAnswer& held, Json& event) {
  const Json document = hold_document(held);
  for (const char* field : {"status", "verdict", "placements", "rest", "fit", "unresolved"}) {
    event[field] = document[field];
  }
}

Json event_json(const char* name) { return {{"schema", kSchema}, {"event", name}}; }

Json answer_json(const char* name, const Tracked& answer, const Part& part, const Catalog* catalog) {
  Json event = event_json(name);
  event["roll"] = answer.roll;
  event["samples"] = answer.samples;
  event["line"] = answer.sample.line;
  event["time"] = answer.sample.time ? json_number(*answer.sample.time) : Json(nullptr);
  // What has not moved yet is 0 and not -0.
  event["reading"] = {
      {"length", json_list(answer.sample.reading.length, [](double length) { return json_number(length + 0.0); })},
      {"turn", json_number(answer.sample.reading.turn)}};
  const Reading& reading = answer.sample.reading;
  if (!reading.is_exact()) {
    event["reading"]["pivot"] = {json_number(reading.turn - reading.pivot), json_number(reading.turn + reading.pivot)};
  }
  if (answer.parts) {
    add_parts(answer, *catalog, event);
    return event;
  }
  if (answer.held) {
    add_held(*answer.held, event);
    return event;
  }
  event["verdict"] = answer.verdict.text();
  event["placements"] = json_list(answer.modes, [&](const Mode& mode) { return mode_json(mode, part); });
  event["rest"] = json_number(answer.rest);
  event["excess"] = json_number(answer.fit.excess);
  event["length_scale"] = json_numbers(answer.fit.length_scale);
  event["length_scale_sd"] = json_numbers(answer.fit.length_scale_sd);
  event["turn_scale"] = json_number(answer.fit.turn_scale);
  event["turn_scale_sd"] = json_number(answer.fit.turn_scale_sd);
  event["turn_bias"] = json_number(answer.fit.turn_bias);
  event["turn_bias_sd"] = json_number(answer.fit.turn_bias_sd);
  return event;
}

/// The answer as `locate` has it, and which touch comes next.
Json touches_json(const char* name, const TouchNews& news) {
  Json event = event_json(name);
  event["samples"] = news.answer.touches.size();
  event["line"] = news.line;
  const Json answer = touches_document(news.answer);
  for (const char* field : {"status", "verdict", "touches", "placements", "unresolved", "rest", "fit", "diagnosis"}) {
    event[field] = answer.value(field, Json(nullptr));
  }
  event["next"] = nullptr;
  if (!news.next) return event;
  Json next = next_touch_document(news.answer, *news.next);
  for (const char* field : {"schema", "verdict", "part", "prospects"}) next.erase(field);
  event["next"] = std::move(next);
  return event;
}

Json counts_json(const WatchCounts& counts) {
  return {{"lines", counts.lines},
          {"samples", counts.samples},
          {"rolls", counts.rolls},
          {"malformed", counts.malformed},
          {"reconnects", counts.reconnects}};
}

class JsonlWriter : public WatchWriter {
 public:
  JsonlWriter(const Part& part, std::ostream& out, std::ostream& err, std::function<bool()> is_ready)
      : WatchWriter(out, err, std::move(is_ready)), part_(part) {}

  void begin(const Part& part, const WatchOptions& options) override {
    fingers_ = options.fingers;
    noise_ = options.noise;
    begin_ = event_json("begin");
    Json& event = begin_;
    catalog_ = options.catalog;
    if (catalog_) {
      event["catalog"] = {{"file", catalog_->path()}, {"parts", catalog_->size()}};
    } else {
      event["part"] = part_json(part);
    }
    event["fingers"] = nullptr;
    if (options.name_b) event["fingers"] = 2;
    event["log"] = options.name_b ? Json::array({options.name, *options.name_b}) : Json(options.name);
    event["noise"] = noise_json(options.noise);
    if (options.wheel) event["wheel"] = json_number(*options.wheel);
    event["prior"] = prior_json(options.prior);
    event["pose_prior"] = pose_prior_json(options.pose);
    event["robust"] = options.robust;
    announce(json_line(event));
  }

  /// As early as the first line says it.
  void knows_fingers(std::size_t count) override {
    if (has_shown()) return;
    begin_["fingers"] = count;
    announce(json_line(begin_));
  }

  void found(const Tracked& answer) override { write_event(answer_json("found", answer, part_, catalog_.get())); }
  void changed(const Tracked& answer) override {
    write_event(answer_json("placements", answer, part_, catalog_.get()));
  }

  void over(const Tracked& answer, RollEnd why) override {
    Json event = answer_json("over", answer, part_, catalog_.get());
    event["why"] = kWhyOver.at(static_cast<std::size_t>(why));
    if (!answer.parts && !answer.held) event["diagnosis"] = diagnoses_json(answer.diagnoses, fingers_, noise_);
    write_event(event);
  }

  void begin_touches() override { knows_fingers(1); }  // the first touch says so

  void touched(const TouchNews& news) override { write_event(touches_json("touch", news)); }

  void no_more_touches(const TouchNews& news, RollEnd why) override {
    Json event = touches_json("over", news);
    event["why"] = kWhyOver.at(static_cast<std::size_t>(why));
    write_event(event);
  }

  void end_touches(WatchEnd why, const std::optional<TouchNews>& last, const WatchCounts& counts) override {
    write_end(why, last ? Json(last->answer.verdict_text()) : Json(nullptr), counts);
  }

  void resumed(const WatchCounts& counts) override {
    Json event = event_json("resumed");
    event["counts"] = counts_json(counts);
    write_event(event);
  }

  void end(WatchEnd why, const Tracked& last, const WatchCounts& counts) override {
    write_end(why, last.roll > 0 ? Json(verdict_of(last)) : Json(nullptr), counts);
  }

 private:
  void write_end(WatchEnd why, Json verdict, const WatchCounts& counts) {
    Json event = event_json("end");
    event["why"] = kWhyEnd.at(static_cast<std::size_t>(why));
    event["verdict"] = std::move(verdict);
    event["counts"] = counts_json(counts);
    event["seconds_per_sample"] = json_number(counts.seconds_per_sample());
    write_event(event);
  }

  void write_event(const Json& event) { write(json_line(event)); }

  Part part_;
  Json begin_;  // the event, as long as it was not shown
  std::shared_ptr<const Catalog> catalog_;
  std::vector<Finger> fingers_;  // and the noise, as given: cures name them
  Noise noise_;
};

}  // namespace

std::unique_ptr<WatchWriter> watch_jsonl(const Part& part, std::ostream& out, std::ostream& err,
                                         std::function<bool()> is_ready) {
  return std::make_unique<JsonlWriter>(part, out, err, std::move(is_ready));
}

}  // namespace rollfix::app
