#include "rollfix/identify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "catalog/on_catalog.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"
#include "watch/meaning.hpp"
#include "watch/rolls.hpp"

// Which part is it, while a roll grows: identify() on the samples so far, asked again whenever Rolls looks.
//   left            parts that remained at the last look: only these are asked next, until the roll is over
// Follows docs/identify.md and docs/watch.md. At the end all parts are asked once more, so that the answer is that of
// identify() for the same rows.
namespace rollfix::catalog {
namespace {

// While more parts than these remain they are only counted: to weigh them all takes longer than the roll itself.
constexpr std::size_t kMostWeighed = 500;
// Fewer samples are no roll yet: what identify() refuses of them says nothing about the parts.
constexpr std::size_t kLeastSamples = 3;
// A change of a part's probability by less is no news: it changes no decision.
constexpr double kOtherProbability = 0.1;

/// A Verdict is of one part's places: unique means one part and one place on it.
Verdict verdict_of(const Identified& found) {
  Verdict verdict;
  verdict.fits_badly = !found.parts.empty() && found.parts.front().answer.verdict.fits_badly;
  if (found.status == Status::incomplete) return verdict;  // undecided
  const bool is_one = found.parts.size() == 1 && found.parts.front().answer.placements.size() == 1;
  verdict.name = found.verdict == "none" ? Verdict::inconsistent : is_one ? Verdict::unique : Verdict::ambiguous;
  return verdict;
}

/// Which parts remain: those that were ruled out are not looked at again before the roll is over.
class OnCatalog final : public Meaning {
 public:
  OnCatalog(const std::shared_ptr<const Catalog>& catalog, const Followed& followed, LogKind kind)
      : catalog_(catalog), followed_(followed), kind_(kind) {}

  void add(const Sample& sample) override { kept_.add(sample); }

  void look(Tracked& answer) override {
    // While many parts remain only bounds are asked, which is quick.
    IdentifyOptions options;
    options.among = left_;
    options.most_searched = kMostWeighed;
    look(answer, options);
    // Only what something fits on narrows the parts down; where nothing fits, those of before are asked again.
    if (answer.parts->counted || !answer.parts->parts.empty()) left_ = answer.parts->left;
  }

  void conclude(Tracked& answer, bool /*explains*/) override { look(answer, {}); }

  /// The first answer is news; then what is_news_of_parts says.
  bool is_news(const Tracked& said, const Tracked& now) const override {
    return !said.parts || is_news_of_parts(*said.parts, *now.parts);
  }

 private:
  /// Asks, and makes a Tracked of the answer. What identify() refuses is all parts while the roll is short, else none.
  void look(Tracked& answer, const IdentifyOptions& options) const {
    const Problem problem = problem_of(followed_, kind_, kept_);
    try {
      answer.parts = std::make_shared<const Identified>(identify(*catalog_, problem, options));
    } catch (const InputError&) {  // so short a roll says nothing yet, or the rows are no roll on any part
      Identified nothing;
      nothing.counted = kept_.size() < kLeastSamples;
      nothing.verdict = "none";
      if (nothing.counted) {
        nothing.left.resize(catalog_->size());
        std::iota(nothing.left.begin(), nothing.left.end(), std::size_t{0});
        nothing.verdict = counted(nothing.left.size(), "part", "parts");
      }
      answer.parts = std::make_shared<const Identified>(std::move(nothing));
    }
    const Identified& found = *answer.parts;
    answer.verdict = verdict_of(found);
    answer.rest = found.rest;
  }

  std::shared_ptr<const Catalog> catalog_;
  Followed followed_;
  LogKind kind_;
  KeptSamples kept_;               // of the roll so far
  std::vector<std::size_t> left_;  // parts that remained at the last look, by their places; empty: all
};

}  // namespace

bool is_news_of_parts(const Identified& said, const Identified& now) {
  if (said.verdict != now.verdict) return true;
  // While they are only counted the number is in the verdict.
  if (said.parts.empty() || now.parts.empty()) return said.parts.size() != now.parts.size();
  const PartFound& before = said.parts.front();
  const PartFound& best = now.parts.front();
  return before.weight.part != best.weight.part || std::abs(before.probability - best.probability) > kOtherProbability;
}

std::unique_ptr<Meaning> meaning_on_catalog(const std::shared_ptr<const Catalog>& catalog, const Followed& followed,
                                            LogKind kind) {
  return std::make_unique<OnCatalog>(catalog, followed, kind);
}

}  // namespace rollfix::catalog

namespace rollfix {

Tracker track(const std::shared_ptr<const Catalog>& catalog, std::vector<Finger> fingers, const Noise& noise,
              TrackOptions options) {
  const auto refuse = [](bool given, const char* name) {
    if (given) throw InputError(fmt::format("`{}` is of a known part; leave it out", name));
  };
  // What is about a place on one part says nothing of many.
  refuse(options.prior.has_value(), "prior");
  refuse(options.wheel.has_value(), "wheel");
  refuse(options.again, "again");
  require_no_corners(fingers, "identify");
  // No step is a jump: which steps the part allows is not known.
  options.log.any_part = true;
  const Followed followed = as_mirrored({any_part_of(*catalog), std::move(fingers), noise, std::move(options)});
  return Tracker(std::make_unique<Tracker::State>(
      followed, [=](LogKind kind) { return catalog::meaning_on_catalog(catalog, followed, kind); }));
}

}  // namespace rollfix
