#include "belief/two/pair_rows.hpp"

#include <algorithm>
#include <cmath>

// Notation:
//   stride    rows of a node: the least power of two with which there are at most kMostNodes nodes
//   median    of up to kRowsOfUnit neighbouring rows where outliers are reckoned with, else a row is its own
//   unit      kRowsOfUnit rows, the least that is kept of a long roll
// Idea: up to kMostRows all rows are kept, as their medians are taken anew when the stride grows. From there on a
// median has as many rows as it ever will, and sums over them are joined two by two: the memory is that of kMostRows.
// Follows docs/two_fingers.md, "The errors".
namespace rollfix::belief {
namespace {

constexpr std::size_t kRowsOfUnit = kRowsOfMedian;
constexpr std::size_t kMostRows = kMostNodes * kRowsOfUnit;

/// `far` up to half turns, as near as can be to `near`.
double brought_near(double far, double near) { return far - kHalfTurn * std::round((far - near) / kHalfTurn); }

/// The mean of so many rows' centres and so many others'.
PairCentres mean_of(const PairCentres& a, double rows_of_a, const PairCentres& b, double rows_of_b) {
  const double of_a = rows_of_a / (rows_of_a + rows_of_b);
  const double of_b = rows_of_b / (rows_of_a + rows_of_b);
  PairCentres mean;
  mean.distance = of_a * a.distance + of_b * b.distance;
  // Directions are known up to half turns: b's is taken near a's.
  mean.direction = of_a * a.direction + of_b * brought_near(b.direction, a.direction);
  for (const std::size_t finger : {0U, 1U}) {
    mean.arm[finger].at = of_a * a.arm[finger].at + of_b * b.arm[finger].at;
    mean.arm[finger].per_length = of_a * a.arm[finger].per_length + of_b * b.arm[finger].per_length;
  }
  return mean;
}

}  // namespace

PairRows::Block PairRows::joined(const Block& a, const Block& b) {
  if (a.rows == 0) return b;
  Block both = a;
  for (const std::size_t finger : {0U, 1U}) both.length[finger] += b.length[finger];
  both.turn += b.turn;
  both.medians += b.medians;
  both.rows += b.rows;
  both.centres = mean_of(a.centres, static_cast<double>(a.rows), b.centres, static_cast<double>(b.rows));
  return both;
}

/// Of the rows that are kept, from `begin` to before `end`.
PairRows::Block PairRows::block_of(std::size_t begin, std::size_t end, std::size_t of_median) const {
  Block block;
  block.rows = end - begin;
  for (std::size_t from = begin; from < end; from += of_median) {
    // One median of `of_median` rows, the last one of fewer.
    const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(std::min(end, from + of_median));
    const Reading middle = median_of({first, last});
    for (const std::size_t finger : {0U, 1U}) block.length[finger] += middle.length[finger];
    block.turn += middle.turn;
    block.medians += 1;
  }
  // Centres are averaged row by row, without medians.
  if (!have_centres()) return block;
  block.centres = centres_[begin];
  for (std::size_t k = begin + 1; k < end; ++k) {
    block.centres = mean_of(block.centres, static_cast<double>(k - begin), centres_[k], 1);
  }
  return block;
}

/// Constant memory: rows, then units of kRowsOfUnit, then blocks; where there are too many of one they become the next.
void PairRows::add(const Reading& row, const std::optional<PairCentres>& centres) {
  if (rows_of_block_ == 0 && size_ == kMostRows) condense();
  // Only when nothing is half filled: all blocks stay of the same number of rows.
  if (blocks_.size() == kMostNodes && open_.rows == 0 && rows_.empty()) halve();
  rows_.push_back(row);
  if (centres) centres_.push_back(*centres);
  with_centres_ += centres ? 1 : 0;
  last_ = row;
  ++size_;
  // All rows are kept, or the unit is not full.
  if (rows_of_block_ == 0 || rows_.size() < kRowsOfUnit) return;
  open_ = joined(open_, block_of(0, kRowsOfUnit, rows_of_median(robust_, kRowsOfUnit)));
  rows_.clear();
  centres_.clear();
  if (open_.rows < rows_of_block_) return;
  blocks_.push_back(open_);
  open_ = {};
}

void PairRows::condense() {
  for (std::size_t begin = 0; begin < rows_.size(); begin += kRowsOfUnit) {
    blocks_.push_back(block_of(begin, begin + kRowsOfUnit, rows_of_median(robust_, kRowsOfUnit)));
  }
  rows_of_block_ = kRowsOfUnit;
  rows_.clear();
  centres_.clear();
}

void PairRows::halve() {
  for (std::size_t k = 0; 2 * k + 1 < blocks_.size(); ++k) blocks_[k] = joined(blocks_[2 * k], blocks_[2 * k + 1]);
  blocks_.resize(blocks_.size() / 2);
  rows_of_block_ *= 2;
}

std::vector<PairRows::Block> PairRows::blocks() const {
  std::vector<Block> all = blocks_;
  if (rows_of_block_ > 0) {
    // What is not a block yet is one of fewer rows.
    Block last = open_;
    if (!rows_.empty()) last = joined(last, block_of(0, rows_.size(), rows_of_median(robust_, kRowsOfUnit)));
    if (last.rows > 0) all.push_back(last);
    return all;
  }
  // All rows are kept: blocks of as many as leave kMostNodes at most.
  std::size_t stride = 1;
  while (stride * kMostNodes < rows_.size()) stride *= 2;
  for (std::size_t begin = 0; begin < rows_.size(); begin += stride) {
    all.push_back(block_of(begin, std::min(rows_.size(), begin + stride), rows_of_median(robust_, stride)));
  }
  return all;
}

/// Of both lengths, of the turn and, where they are looked at, of the centres' distance and direction.
std::vector<Course> PairRows::courses_of(const std::vector<Block>& blocks, const PairErrors& errors) const {
  const double contact = errors.contact_sd();
  // A row's turn is off by both orientations and, with u, by both contacts' errors through 1/r.
  const double turn =
      std::hypot(std::sqrt(errors.turn_variance()), contact * errors.normal_turn(0), contact * errors.normal_turn(1));
  std::vector<Course> courses{{{}, contact}, {{}, contact}, {{}, turn}};
  for (const Block& block : blocks) {
    for (const std::size_t finger : {0U, 1U}) courses[finger].values.push_back(block.length[finger] / block.medians);
    courses[2].values.push_back(block.turn / block.medians);
  }
  if (have_centres() && errors.centre_variance() > 0) {
    const double distance = std::sqrt(2 * errors.centre_variance());
    courses.push_back({{}, distance});
    // The direction turns with errors across the chord, and with the mean of both normals.
    courses.push_back({{}, std::hypot(distance / blocks.front().centres.distance, 0.5 * turn)});
    double last = blocks.front().centres.direction;
    for (const Block& block : blocks) {
      last = brought_near(block.centres.direction, last);
      courses[3].values.push_back(block.centres.distance);
      courses[4].values.push_back(last);
    }
  }
  for (Course& course : courses) {
    // Noise of the mean of a block.
    course.sd /= std::sqrt(static_cast<double>(blocks.front().rows));
    for (const Block& block : blocks) course.rows.push_back(static_cast<double>(block.rows));
  }
  return courses;
}

/// As few blocks as even motion allows, each as it was in the middle of its rows.
std::vector<PairRows::Block> PairRows::joined_where_even(std::vector<Block> blocks, const PairErrors& errors) const {
  // Of outliers it is not known whether a motion is even; and few blocks are left as they are.
  if (robust_ || blocks.size() < 2 * kFewestMeans) return blocks;
  // Rows that jump from one to the next by more than noise are no smooth motion.
  if (!std::ranges::all_of(courses_of(blocks, errors), is_even)) return blocks;
  const auto middles = [&](std::size_t lots) {
    // Blocks are dealt out evenly: lots differ by one block at most.
    std::vector<Block> few(lots);
    for (std::size_t k = 0; k < lots; ++k) {
      for (std::size_t from = k * blocks.size() / lots; from < (k + 1) * blocks.size() / lots; ++from) {
        few[k] = joined(few[k], blocks[from]);
      }
    }
    return middles_of(std::move(few), errors);
  };
  return fewest_means(blocks.size() / 2, middles).value_or(blocks);
}

/// What was in the middles of such means; none: they go too uneven for that.
std::optional<std::vector<PairRows::Block>> PairRows::middles_of(std::vector<Block> means,
                                                                 const PairErrors& errors) const {
  std::vector<std::vector<double>> middles;
  for (const Course& course : courses_of(means, errors)) {
    const auto of_course = at_middles(course);
    // One uneven measurement is enough.
    if (!of_course) return std::nullopt;
    middles.push_back(*of_course);
  }
  for (std::size_t k = 0; k < means.size(); ++k) {
    Block& mean = means[k];
    // Blocks hold sums over medians.
    for (const std::size_t finger : {0U, 1U}) mean.length[finger] = middles[finger][k] * mean.medians;
    mean.turn = middles[2][k] * mean.medians;
    // No centres.
    if (middles.size() == 3) continue;
    mean.centres.distance = middles[3][k];
    mean.centres.direction = middles[4][k];
  }
  return means;
}

/// The facing as a row of its own, then the means. With the facing each turn becomes absolute: Theta(s) - Theta(t)
/// there.
std::vector<PairNode> PairRows::nodes(const std::optional<double>& facing, const std::optional<PairCentres>& centres,
                                      const PairErrors& errors) const {
  std::vector<PairNode> nodes;
  const bool looks_at_centres = centres && have_centres();
  if (facing) {
    PairNode first;
    if (looks_at_centres) first.centres = centres;
    first.is_facing = true;
    first.turn = *facing;
    nodes.push_back(first);
  }
  const double lift = errors.absolute() && facing ? *facing : 0;
  std::array<Travel, 2> travel{errors.travel(), errors.travel()};
  std::size_t begin = 0;
  for (const Block& block : joined_where_even(blocks(), errors)) {
    PairNode node;
    for (const std::size_t finger : {0U, 1U}) node.length[finger] = block.length[finger] / block.medians;
    node.turn = block.turn / block.medians + lift;
    node.gathered = static_cast<double>(block.rows);
    for (const std::size_t finger : {0U, 1U}) {
      // A mark is at the middle of its rows, by their number from 0 on.
      const double middle = 0.5 * static_cast<double>(2 * begin + block.rows - 1);
      const Travel::Mark mark{middle, node.length[finger], errors.contact_variance() / block.medians};
      node.travelled[finger] = travel[finger].add(mark);
    }
    // By the finger that has travelled more.
    const double worth = errors.worth(std::max(node.travelled[0], node.travelled[1]), node.gathered);
    // Where rows lie on a slope their median is about as noisy as one of them: a block is worth its medians.
    node.rows = block.medians * worth / node.gathered;
    if (looks_at_centres) node.centres = block.centres;
    nodes.push_back(node);
    begin += block.rows;
  }
  return nodes;
}

}  // namespace rollfix::belief
