// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/statement_match.h"

#include <algorithm>
#include <unordered_map>

namespace tranos::session {

namespace {

using Ids = std::vector<std::uint32_t>;
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::size_t kMostCells = 1 << 20;       // of a table of equal ones
constexpr std::size_t kMostLikenesses = 1 << 16;  // computed for one gap
constexpr std::size_t kFew = 8;                   // statements that share a part
constexpr double kAlikeBetweenNeighbours = 0.3;
constexpr double kAlikeElsewhere = 0.6;
constexpr double kMuchAlike = 0.7;  // before neighbours are looked at

// The pairs that ascend in both, as many as possible.
Pairs Ascending(const Pairs& pairs) {
  std::vector<std::size_t> tails, before(pairs.size(), pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto place = std::lower_bound(
        tails.begin(), tails.end(), pairs[i].second,
        [&](std::size_t tail, std::uint32_t value) { return pairs[tail].second < value; });
    if (place != tails.begin()) before[i] = *std::prev(place);
    if (place == tails.end())
      tails.push_back(i);
    else
      *place = i;
  }
  Pairs out;
  for (std::size_t i = tails.empty() ? pairs.size() : tails.back(); i < pairs.size(); i = before[i])
    out.push_back(pairs[i]);
  std::reverse(out.begin(), out.end());
  return out;
}

// Common subsequences: equal ends, then anchors that are unique on both sides, then a table.
class Aligner {
 public:
  Aligner(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b)
      : a_(a), b_(b) {}

  void Align(std::size_t a0, std::size_t a1, std::size_t b0, std::size_t b1) {
    while (a0 < a1 && b0 < b1 && a_[a0] == b_[b0]) Pair(a0++, b0++);
    while (a0 < a1 && b0 < b1 && a_[a1 - 1] == b_[b1 - 1]) Pair(--a1, --b1);
    if (a0 == a1 || b0 == b1) return;
    if ((a1 - a0) * (b1 - b0) <= kMostCells) return Table(a0, a1, b0, b1);
    const Pairs anchors = Ascending(UniquePairs(a0, a1, b0, b1));
    if (anchors.empty()) return;  // long and far apart: what is left counts as moved
    for (const auto& [i, j] : anchors) {
      if (i < a0 || j < b0) continue;
      Align(a0, i, b0, j);
      Pair(i, j);
      a0 = i + 1, b0 = j + 1;
    }
    Align(a0, a1, b0, b1);
  }
  Pairs Take() {
    std::sort(pairs_.begin(), pairs_.end());
    return std::move(pairs_);
  }

 private:
  void Pair(std::size_t i, std::size_t j) {
    pairs_.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
  }
  Pairs UniquePairs(std::size_t a0, std::size_t a1, std::size_t b0, std::size_t b1) const {
    struct Seen {
      std::uint32_t count_a = 0, count_b = 0, at_b = 0;
    };
    std::unordered_map<std::uint64_t, Seen> seen;
    for (std::size_t i = a0; i < a1; ++i) ++seen[a_[i]].count_a;
    for (std::size_t j = b0; j < b1; ++j) {
      Seen& entry = seen[b_[j]];
      ++entry.count_b;
      entry.at_b = static_cast<std::uint32_t>(j);
    }
    Pairs out;
    for (std::size_t i = a0; i < a1; ++i) {
      const Seen& entry = seen[a_[i]];
      if (entry.count_a == 1 && entry.count_b == 1)
        out.emplace_back(static_cast<std::uint32_t>(i), entry.at_b);
    }
    return out;
  }
  void Table(std::size_t a0, std::size_t a1, std::size_t b0, std::size_t b1) {
    const std::size_t rows = a1 - a0, columns = b1 - b0;
    std::vector<std::uint32_t> best((rows + 1) * (columns + 1), 0);
    const auto at = [&](std::size_t i, std::size_t j) -> std::uint32_t& {
      return best[i * (columns + 1) + j];
    };
    for (std::size_t i = rows; i-- > 0;) {
      for (std::size_t j = columns; j-- > 0;) {
        at(i, j) =
            a_[a0 + i] == b_[b0 + j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
      }
    }
    for (std::size_t i = 0, j = 0; i < rows && j < columns;) {
      if (a_[a0 + i] == b_[b0 + j])
        Pair(a0 + i++, b0 + j++);
      else if (at(i + 1, j) >= at(i, j + 1))
        ++i;
      else
        ++j;
    }
  }

  const std::vector<std::uint64_t>& a_;
  const std::vector<std::uint64_t>& b_;
  Pairs pairs_;
};

class StatementMatcher {
 public:
  StatementMatcher(const StatementTree& a, const StatementTree& b) : a_(a), b_(b) {
    match_.b_of_a.assign(a.statements.size(), kNoStatement);
    match_.a_of_b.assign(b.statements.size(), kNoStatement);
  }

  StatementMatch Run() {
    MatchBlocks(0, 0);
    MatchEqualAnywhere();
    MatchContainersByContent();
    PairByRareItems(FreeOnesA(), FreeOnesB(), kMuchAlike);
    // Blocks that were matched by now, in order: their changed statements between the same
    // neighbours.
    for (std::uint32_t i = 0; i < a_.statements.size(); ++i) {
      if (match_.b_of_a[i] != kNoStatement && !a_.statements[i].children.empty())
        MatchAlikeWithin(i, match_.b_of_a[i]);
    }
    MatchAlikeAnywhere();
    return std::move(match_);
  }

 private:
  const Statement& A(std::uint32_t i) const { return a_.statements[i]; }
  const Statement& B(std::uint32_t j) const { return b_.statements[j]; }
  bool FreeA(std::uint32_t i) const { return match_.b_of_a[i] == kNoStatement; }
  bool FreeB(std::uint32_t j) const { return match_.a_of_b[j] == kNoStatement; }
  void Pair(std::uint32_t i, std::uint32_t j) {
    match_.b_of_a[i] = j;
    match_.a_of_b[j] = i;
  }
  // Equal statements, with all that is in them.
  void PairAll(std::uint32_t i, std::uint32_t j) {
    if (!FreeA(i) || !FreeB(j)) return;
    Pair(i, j);
    const std::size_t count = std::min(A(i).children.size(), B(j).children.size());
    for (std::size_t n = 0; n < count; ++n) PairAll(A(i).children[n], B(j).children[n]);
  }

  void MatchBlocks(std::uint32_t i, std::uint32_t j) {
    Pair(i, j);
    const Ids &x = A(i).children, &y = B(j).children;
    std::vector<std::uint64_t> hashes_x, hashes_y;
    for (const std::uint32_t child : x) hashes_x.push_back(A(child).hash);
    for (const std::uint32_t child : y) hashes_y.push_back(B(child).hash);
    for (const auto& [n, m] : CommonSubsequence(hashes_x, hashes_y)) PairAll(x[n], y[m]);
    PairEqual(x, y);
    PairContainers(x, y);
  }
  // Equal ones that are left, in order, wherever they are in the two lists.
  void PairEqual(const Ids& x, const Ids& y) {
    std::unordered_map<std::uint64_t, Ids> waiting;
    for (auto child = y.rbegin(); child != y.rend(); ++child) {
      if (FreeB(*child)) waiting[B(*child).hash].push_back(*child);
    }
    if (waiting.empty()) return;
    for (const std::uint32_t child : x) {
      if (!FreeA(child)) continue;
      const auto found = waiting.find(A(child).hash);
      if (found == waiting.end() || found->second.empty()) continue;
      PairAll(child, found->second.back());
      found->second.pop_back();
    }
  }
  // Blocks that are alike, the most alike first.
  void PairContainers(const Ids& x, const Ids& y) {
    Ids blocks_x, blocks_y;
    for (const std::uint32_t i : x) {
      if (FreeA(i) && IsBlock(A(i))) blocks_x.push_back(i);
    }
    for (const std::uint32_t j : y) {
      if (FreeB(j) && IsBlock(B(j))) blocks_y.push_back(j);
    }
    if (blocks_x.size() * blocks_y.size() > kMostLikenesses) {
      PairByRareItems(blocks_x, blocks_y, kAlikeBetweenNeighbours);
      return;
    }
    std::vector<Candidate> candidates;
    for (const std::uint32_t i : blocks_x) {
      for (const std::uint32_t j : blocks_y) Consider(i, j, kAlikeBetweenNeighbours, &candidates);
    }
    PairBest(std::move(candidates));
  }
  static bool IsBlock(const Statement& statement) {
    return statement.kind == Statement::kLoop || statement.kind == Statement::kBlock;
  }

  void MatchEqualAnywhere() { PairEqual(FreeOnesA(), FreeOnesB()); }
  Ids FreeOnesA() const { return FreeOnes(match_.b_of_a); }
  Ids FreeOnesB() const { return FreeOnes(match_.a_of_b); }
  static Ids FreeOnes(const Ids& match) {
    Ids out;
    for (std::uint32_t i = 1; i < match.size(); ++i) {
      if (match[i] == kNoStatement) out.push_back(i);
    }
    return out;
  }
  // A block that is free whose statements went to one free block is that block.
  void MatchContainersByContent() {
    for (std::uint32_t i = static_cast<std::uint32_t>(a_.statements.size()); i-- > 1;) {
      if (!FreeA(i) || !IsBlock(A(i))) continue;
      std::unordered_map<std::uint32_t, std::size_t> votes;
      for (const std::uint32_t child : A(i).children) {
        if (FreeA(child)) continue;
        const std::uint32_t parent = B(match_.b_of_a[child]).parent;
        if (parent != kNoStatement && FreeB(parent) && B(parent).head == A(i).head) ++votes[parent];
      }
      const auto best =
          std::max_element(votes.begin(), votes.end(), [](const auto& p, const auto& q) {
            return std::pair{p.second, q.first} < std::pair{q.second, p.first};
          });
      if (best != votes.end() && 2 * best->second >= A(i).children.size()) Pair(i, best->first);
    }
  }

  // What two statements have in common, 0 to 1; 0 if they are different commands.
  double Likeness(const Statement& x, const Statement& y) const {
    if (x.kind != y.kind || x.head != y.head) return 0;
    std::vector<std::uint64_t> p = x.items, q = y.items;
    for (const std::uint32_t child : x.children) p.push_back(A(child).hash);
    for (const std::uint32_t child : y.children) q.push_back(B(child).hash);
    std::sort(p.begin(), p.end());
    std::sort(q.begin(), q.end());
    std::size_t common = 0;
    for (std::size_t i = 0, j = 0; i < p.size() && j < q.size();) {
      if (p[i] == q[j])
        ++common, ++i, ++j;
      else if (p[i] < q[j])
        ++i;
      else
        ++j;
    }
    // The head is common; two statements of a head alone are the same.
    return (1.0 + 2.0 * static_cast<double>(common)) /
           (1.0 + static_cast<double>(p.size() + q.size()));
  }

  void MatchAlikeWithin(std::uint32_t i, std::uint32_t j) {
    const Ids &x = A(i).children, &y = B(j).children;
    std::unordered_map<std::uint32_t, std::uint32_t> place_in_y;
    for (std::uint32_t m = 0; m < y.size(); ++m) place_in_y[y[m]] = m;
    Pairs matched;
    for (std::uint32_t n = 0; n < x.size(); ++n) {
      if (FreeA(x[n])) continue;
      const auto found = place_in_y.find(match_.b_of_a[x[n]]);
      if (found != place_in_y.end()) matched.emplace_back(n, found->second);
    }
    Pairs anchors = Ascending(matched);
    anchors.emplace_back(static_cast<std::uint32_t>(x.size()),
                         static_cast<std::uint32_t>(y.size()));
    std::uint32_t n = 0, m = 0;
    for (const auto& [to_n, to_m] : anchors) {
      Ids gap_x, gap_y;
      for (; n < to_n; ++n) {
        if (FreeA(x[n])) gap_x.push_back(x[n]);
      }
      for (; m < to_m; ++m) {
        if (FreeB(y[m])) gap_y.push_back(y[m]);
      }
      MatchGap(gap_x, gap_y);
      n = to_n + 1, m = to_m + 1;
    }
  }
  void MatchGap(Ids x, Ids y) {
    if (x.empty() || y.empty()) return;
    if (x.size() * y.size() > kMostLikenesses) {
      PairByRareItems(x, y, kAlikeBetweenNeighbours);
      std::erase_if(x, [&](std::uint32_t i) { return !FreeA(i); });
      std::erase_if(y, [&](std::uint32_t j) { return !FreeB(j); });
    }
    if (x.size() * y.size() > kMostLikenesses) return MatchLongGap(x, y);
    const std::size_t columns = y.size() + 1;
    std::vector<double> best((x.size() + 1) * columns, 0), alike(x.size() * y.size());
    for (std::size_t n = x.size(); n-- > 0;) {
      for (std::size_t m = y.size(); m-- > 0;) {
        double likeness = Likeness(A(x[n]), B(y[m]));
        if (likeness < kAlikeBetweenNeighbours) likeness = 0;
        alike[n * y.size() + m] = likeness;
        double& here = best[n * columns + m];
        here = std::max(best[(n + 1) * columns + m], best[n * columns + m + 1]);
        if (likeness > 0) here = std::max(here, likeness + best[(n + 1) * columns + m + 1]);
      }
    }
    for (std::size_t n = 0, m = 0; n < x.size() && m < y.size();) {
      const double likeness = alike[n * y.size() + m];
      if (likeness > 0 && best[n * columns + m] <= likeness + best[(n + 1) * columns + m + 1]) {
        PairChanged(x[n++], y[m++]);
      } else if (best[(n + 1) * columns + m] >= best[n * columns + m + 1]) {
        ++n;
      } else {
        ++m;
      }
    }
  }
  // Too long for a table of likenesses: in order, by command.
  void MatchLongGap(const Ids& x, const Ids& y) {
    std::vector<std::uint64_t> heads_x, heads_y;
    for (const std::uint32_t i : x) heads_x.push_back(A(i).head);
    for (const std::uint32_t j : y) heads_y.push_back(B(j).head);
    for (const auto& [n, m] : CommonSubsequence(heads_x, heads_y)) {
      if (Likeness(A(x[n]), B(y[m])) >= kAlikeBetweenNeighbours) PairChanged(x[n], y[m]);
    }
  }
  void PairChanged(std::uint32_t i, std::uint32_t j) {
    if (IsBlock(A(i))) {
      MatchBlocks(i, j);
    } else {
      Pair(i, j);
    }
  }

  void MatchAlikeAnywhere() {
    const Ids x = FreeOnesA(), y = FreeOnesB();
    PairByRareItems(x, y, kAlikeElsewhere);
    std::unordered_map<std::uint64_t, Ids> free_b;
    for (const std::uint32_t j : y) {
      if (FreeB(j)) free_b[B(j).head].push_back(j);
    }
    std::vector<Candidate> candidates;
    std::size_t looked_at = 0;
    for (const std::uint32_t i : x) {
      if (!FreeA(i)) continue;
      const auto found = free_b.find(A(i).head);
      if (found == free_b.end()) continue;
      looked_at += found->second.size();
      if (looked_at > kMostLikenesses) break;
      for (const std::uint32_t j : found->second) Consider(i, j, kAlikeElsewhere, &candidates);
    }
    PairBest(std::move(candidates));
  }

  struct Candidate {
    double likeness;
    std::uint32_t i, j;
  };
  void Consider(std::uint32_t i, std::uint32_t j, double least,
                std::vector<Candidate>* candidates) const {
    const double likeness = Likeness(A(i), B(j));
    if (likeness >= least) candidates->push_back({likeness, i, j});
  }
  void PairBest(std::vector<Candidate> candidates) {
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const Candidate& p, const Candidate& q) { return p.likeness > q.likeness; });
    for (const Candidate& candidate : candidates) {
      if (FreeA(candidate.i) && FreeB(candidate.j)) PairChanged(candidate.i, candidate.j);
    }
  }
  // Statements of one command that share a part which few others have.
  void PairByRareItems(const Ids& x, const Ids& y, double least) {
    std::unordered_map<std::uint64_t, Ids> with_item;
    for (const std::uint32_t j : y) {
      for (const std::uint64_t item : B(j).items) with_item[item ^ B(j).head].push_back(j);
    }
    std::vector<Candidate> candidates;
    for (const std::uint32_t i : x) {
      for (const std::uint64_t item : A(i).items) {
        const auto found = with_item.find(item ^ A(i).head);
        if (found == with_item.end() || found->second.size() > kFew) continue;
        for (const std::uint32_t j : found->second) Consider(i, j, least, &candidates);
      }
    }
    PairBest(std::move(candidates));
  }

  const StatementTree& a_;
  const StatementTree& b_;
  StatementMatch match_;
};

}  // namespace

Pairs CommonSubsequence(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  Aligner aligner(a, b);
  aligner.Align(0, a.size(), 0, b.size());
  return aligner.Take();
}

StatementMatch MatchStatements(const StatementTree& a, const StatementTree& b) {
  return StatementMatcher(a, b).Run();
}

}  // namespace tranos::session
