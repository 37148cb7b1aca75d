// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/element_match.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "session/correspondence.h"

namespace tranos::session {

namespace {

using Ids = std::vector<int>;
constexpr std::size_t kMostCells = 1 << 18;  // of a table of alignment
constexpr std::size_t kFewestPoints = 3;     // of a shape that tells something of what it is

struct HashOfHash {
  std::size_t operator()(const model::Hash128& hash) const {
    return static_cast<std::size_t>(hash.low ^ hash.high);
  }
};

std::uint64_t HashOfValue(const model::Value& value) {
  model::Hasher hasher;
  model::AddToHash(hasher, value);
  return hasher.Finish().low;
}

// The elements of a run, groups before their members, and the order in which loops took their
// turns.
class Subjects {
 public:
  Subjects(const RunRecord& record, const StatementTree& tree) : record_(record), tree_(tree) {
    NoteTurns();
    record.result.outcome.state.model.ForEach(
        [&](const model::ElementPtr& element) { Add(*element, -1); });
  }

  std::vector<Subject> list;
  // By loop: the values of its variable in the order in which they first came.
  std::unordered_map<std::uint32_t, std::vector<std::uint64_t>> turns_of_loop;

 private:
  void NoteTurns() {
    std::unordered_map<std::uint32_t, std::unordered_set<std::uint64_t>> seen;
    statements_.reserve(record_.firings.size());
    for (const Firing& firing : record_.firings) {
      const bool is_group = firing.command.empty();
      const std::uint32_t statement =
          is_group ? tree_.EndingAt(firing.at.begin) : tree_.At(firing.at.begin);
      statements_.push_back(statement);
      if (firing.turns.empty()) continue;
      const auto loops = tree_.LoopsAround(statement);
      for (std::size_t i = 0; i < std::min(loops.size(), firing.turns.size()); ++i) {
        const std::uint64_t value = HashOfValue(firing.turns[i]);
        if (seen[loops[i]].insert(value).second) turns_of_loop[loops[i]].push_back(value);
      }
    }
  }
  void Add(const model::Element& element, int parent) {
    Subject subject;
    subject.element = &element;
    subject.parent = parent;
    if (parent >= 0) {
      const Subject& group = list[static_cast<std::size_t>(parent)];
      subject.depth = group.depth + 1;
      subject.firing = group.firing;
    }
    if (element.id < record_.origins.size() && record_.origins[element.id].firing != kNoFiring) {
      subject.firing = record_.origins[element.id].firing;
    }
    NameOne(&subject);
    if (subject.firing != kNoFiring) {
      subject.statement = statements_[subject.firing];
      const std::size_t loops = tree_.statements[subject.statement].loops;
      const auto& turns = record_.firings[subject.firing].turns;
      for (std::size_t i = 0; i < std::min(loops, turns.size()); ++i)
        subject.turns.push_back(HashOfValue(turns[i]));
    }
    const int at = static_cast<int>(list.size());
    list.push_back(std::move(subject));
    if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
      for (const model::ElementPtr& member : (*group)->members) Add(*member, at);
    }
  }
  void NameOne(Subject* subject) const {
    const std::string_view name = subject->element->name_or_empty();
    if (name.empty()) return;
    if (subject->parent >= 0)
      subject->name = list[static_cast<std::size_t>(subject->parent)].name + ".";
    subject->name += name;
  }

  const RunRecord& record_;
  const StatementTree& tree_;
  std::vector<std::uint32_t> statements_;  // by firing
};

// What one of the side's subjects is aligned by: its statement in the other script, and its turns
// there.
struct Place {
  std::uint32_t statement = kNoStatement;
  std::vector<std::uint64_t> turns;
  friend auto operator<=>(const Place&, const Place&) = default;
};

// Says where in script b a place of script a is.
class PlaceMap {
 public:
  PlaceMap(const StatementTree& a, const StatementTree& b, StatementMatch match, const Subjects& x,
           const Subjects& y)
      : a_(a), b_(b), match_(std::move(match)) {
    for (const auto& [loop, turns] : x.turns_of_loop) {
      const std::uint32_t other = match_.b_of_a[loop];
      const auto found = y.turns_of_loop.find(other);
      if (other != kNoStatement && found != y.turns_of_loop.end())
        MapTurns(loop, turns, found->second);
    }
  }

  bool HasCounterpartA(const Subject& x) const {
    return match_.b_of_a[x.statement] != kNoStatement;
  }
  bool HasCounterpartB(const Subject& y) const {
    return match_.a_of_b[y.statement] != kNoStatement;
  }

  Place OfA(const Subject& x) const {
    const std::uint32_t statement = match_.b_of_a[x.statement];
    if (statement == kNoStatement || x.firing == kNoFiring) return {};
    Place place{statement, {}};
    if (!SameLoops(x.statement, statement)) return place;
    const auto loops = a_.LoopsAround(x.statement);
    for (std::size_t i = 0; i < std::min(loops.size(), x.turns.size()); ++i) {
      const auto found = turns_.find({loops[i], x.turns[i]});
      if (found == turns_.end()) return {};  // a turn that is not there any more
      place.turns.push_back(found->second);
    }
    return place;
  }
  Place OfB(const Subject& y) const {
    const std::uint32_t statement = match_.a_of_b[y.statement];
    if (statement == kNoStatement || y.firing == kNoFiring) return {};
    if (!SameLoops(statement, y.statement)) return {y.statement, {}};
    return {y.statement, y.turns};
  }

 private:
  // Whether the loops around the two are each other's, so that their turns can be told apart.
  bool SameLoops(std::uint32_t i, std::uint32_t j) const {
    if (a_.statements[i].loops == 0 && b_.statements[j].loops == 0) return true;
    const auto p = a_.LoopsAround(i), q = b_.LoopsAround(j);
    if (p.size() != q.size()) return false;
    for (std::size_t n = 0; n < p.size(); ++n) {
      if (match_.b_of_a[p[n]] != q[n]) return false;
    }
    return true;
  }
  // Turns with the same value are the same turn. Where a list has changed in between, turns go by
  // their order; where no value is left, by their number.
  void MapTurns(std::uint32_t loop, const std::vector<std::uint64_t>& p,
                const std::vector<std::uint64_t>& q) {
    const std::unordered_set<std::uint64_t> in_q(q.begin(), q.end());
    bool any_common = false;
    for (const std::uint64_t value : p) {
      if (!in_q.contains(value)) continue;
      turns_[{loop, value}] = value;
      any_common = true;
    }
    if (!any_common) {
      for (std::size_t i = 0; i < std::min(p.size(), q.size()); ++i) turns_[{loop, p[i]}] = q[i];
      return;
    }
    if (p.size() != q.size()) return;
    const std::unordered_set<std::uint64_t> in_p(p.begin(), p.end());
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!in_q.contains(p[i]) && !in_p.contains(q[i])) turns_[{loop, p[i]}] = q[i];
    }
  }

  const StatementTree& a_;
  const StatementTree& b_;
  StatementMatch match_;
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::uint64_t> turns_;
};

class ElementMatcher {
 public:
  ElementMatcher(Subjects x, Subjects y, const PlaceMap& places) : places_(places) {
    match_.a = std::move(x.list);
    match_.b = std::move(y.list);
    match_.b_of_a.assign(match_.a.size(), ElementMatch::kFree);
    match_.a_of_b.assign(match_.b.size(), ElementMatch::kFree);
    for (const Subject& subject : match_.a) places_a_.push_back(places_.OfA(subject));
    for (const Subject& subject : match_.b) places_b_.push_back(places_.OfB(subject));
    FindMembers(match_.a, &members_a_);
    FindMembers(match_.b, &members_b_);
  }

  ElementMatch Run() {
    MatchEqual(members_a_[0], members_b_[0]);
    MatchGroups(members_a_[0], members_b_[0]);
    const Ids all_a = FreeOnes(match_.b_of_a), all_b = FreeOnes(match_.a_of_b);
    MatchEqual(all_a, all_b);
    MatchByName(all_a, all_b);
    MatchByPlace(all_a, all_b);
    MatchByShape(all_a, all_b);
    return std::move(match_);
  }

 private:
  const Subject& A(int i) const { return match_.a[static_cast<std::size_t>(i)]; }
  const Subject& B(int j) const { return match_.b[static_cast<std::size_t>(j)]; }
  int& OfA(int i) { return match_.b_of_a[static_cast<std::size_t>(i)]; }
  int& OfB(int j) { return match_.a_of_b[static_cast<std::size_t>(j)]; }
  bool FreeA(int i) { return OfA(i) == ElementMatch::kFree; }
  bool FreeB(int j) { return OfB(j) == ElementMatch::kFree; }
  static bool IsGroup(const Subject& subject) {
    return std::holds_alternative<model::GroupPtr>(subject.element->geometry);
  }

  // By parent + 1: the members, so that those at the top come first.
  static void FindMembers(const std::vector<Subject>& list, std::vector<Ids>* members) {
    members->resize(list.size() + 1);
    for (std::size_t i = 0; i < list.size(); ++i)
      (*members)[static_cast<std::size_t>(list[i].parent + 1)].push_back(static_cast<int>(i));
  }
  static Ids FreeOnes(const std::vector<int>& match) {
    Ids out;
    for (std::size_t i = 0; i < match.size(); ++i) {
      if (match[i] == ElementMatch::kFree) out.push_back(static_cast<int>(i));
    }
    return out;
  }

  void Pair(int i, int j) {
    OfA(i) = j;
    OfB(j) = i;
  }
  // With all that is within.
  void PairWhole(int i, int j) {
    Pair(i, j);
    Close(i, members_a_, &match_.b_of_a);
    Close(j, members_b_, &match_.a_of_b);
  }
  static void Close(int group, const std::vector<Ids>& members, std::vector<int>* match) {
    for (const int member : members[static_cast<std::size_t>(group + 1)]) {
      (*match)[static_cast<std::size_t>(member)] = ElementMatch::kWithin;
      Close(member, members, match);
    }
  }
  bool AnyMatchedWithin(int group, const std::vector<Ids>& members,
                        const std::vector<int>& match) const {
    for (const int member : members[static_cast<std::size_t>(group + 1)]) {
      if (match[static_cast<std::size_t>(member)] != ElementMatch::kFree ||
          AnyMatchedWithin(member, members, match))
        return true;
    }
    return false;
  }

  // Of equal ones, those that come from the same place go together.
  void MatchEqual(const Ids& x, const Ids& y) {
    std::unordered_map<model::Hash128, std::pair<Ids, Ids>, HashOfHash> by_hash;
    for (const int i : x) {
      if (FreeA(i)) by_hash[A(i).element->hash].first.push_back(i);
    }
    for (const int j : y) {
      if (!FreeB(j)) continue;
      const auto found = by_hash.find(B(j).element->hash);
      if (found != by_hash.end()) found->second.second.push_back(j);
    }
    for (const int i : x) {
      if (!FreeA(i)) continue;
      auto& [same_a, same_b] = by_hash[A(i).element->hash];
      if (!same_b.empty()) MatchAlike(same_a, same_b);
    }
  }
  void MatchAlike(const Ids& x, const Ids& y) {
    std::map<Place, Ids> waiting;
    for (auto j = y.rbegin(); j != y.rend(); ++j)
      waiting[places_b_[static_cast<std::size_t>(*j)]].push_back(*j);
    for (const int i : x) {
      const Place& place = places_a_[static_cast<std::size_t>(i)];
      const auto found = waiting.find(place);
      if (place.statement == kNoStatement || found == waiting.end() || found->second.empty())
        continue;
      PairEqual(i, found->second.back());
      found->second.pop_back();
    }
    auto j = y.begin();
    for (const int i : x) {
      if (!FreeA(i)) continue;
      while (j != y.end() && !FreeB(*j)) ++j;
      if (j == y.end()) return;
      PairEqual(i, *j);
    }
  }
  void PairEqual(int i, int j) {
    // What is in them may have gone to other places before.
    if (AnyMatchedWithin(i, members_a_, match_.b_of_a) ||
        AnyMatchedWithin(j, members_b_, match_.a_of_b))
      return;
    PairWhole(i, j);
  }

  // Groups that are each other's: moved as a whole, or their members are matched in turn.
  void MatchGroups(const Ids& x, const Ids& y) {
    Ids groups_a, groups_b;
    std::copy_if(x.begin(), x.end(), std::back_inserter(groups_a),
                 [&](int i) { return FreeA(i) && IsGroup(A(i)); });
    std::copy_if(y.begin(), y.end(), std::back_inserter(groups_b),
                 [&](int j) { return FreeB(j) && IsGroup(B(j)); });
    if (groups_a.empty() || groups_b.empty()) return;
    MatchByName(groups_a, groups_b);
    MatchByPlace(groups_a, groups_b);
    for (const int i : groups_a) {
      const int j = OfA(i);
      if (j < 0) continue;
      if (RigidDisplacement(*A(i).element, *B(j).element)) {
        PairWhole(i, j);
        continue;
      }
      const Ids &within_a = members_a_[static_cast<std::size_t>(i + 1)],
                &within_b = members_b_[static_cast<std::size_t>(j + 1)];
      MatchEqual(within_a, within_b);
      MatchGroups(within_a, within_b);
    }
  }

  void MatchByName(const Ids& x, const Ids& y) {
    std::unordered_map<std::string_view, std::pair<Ids, Ids>> by_name;
    for (const int i : x) {
      if (FreeA(i) && !A(i).name.empty()) by_name[A(i).name].first.push_back(i);
    }
    for (const int j : y) {
      if (FreeB(j) && !B(j).name.empty()) by_name[B(j).name].second.push_back(j);
    }
    for (const auto& [name, same] : by_name) {
      if (same.first.size() == 1 && same.second.size() == 1) Pair(same.first[0], same.second[0]);
    }
  }

  // Within one statement and turn: between what is matched already, in order.
  void MatchByPlace(const Ids& x, const Ids& y) {
    std::map<Place, std::pair<Ids, Ids>> affected;
    for (const int i : x) {
      if (FreeA(i)) affected[places_a_[static_cast<std::size_t>(i)]].first.push_back(i);
    }
    for (const int j : y) {
      if (!FreeB(j)) continue;
      const auto found = affected.find(places_b_[static_cast<std::size_t>(j)]);
      if (found != affected.end()) found->second.second.push_back(j);
    }
    std::erase_if(affected, [](const auto& entry) {
      return entry.first.statement == kNoStatement || entry.second.first.empty() ||
             entry.second.second.empty();
    });
    if (affected.empty()) return;
    std::map<Place, std::pair<Ids, Ids>> whole;
    for (std::size_t i = 0; i < match_.a.size(); ++i) {
      if (affected.contains(places_a_[i])) whole[places_a_[i]].first.push_back(static_cast<int>(i));
    }
    for (std::size_t j = 0; j < match_.b.size(); ++j) {
      if (affected.contains(places_b_[j]))
        whole[places_b_[j]].second.push_back(static_cast<int>(j));
    }
    const std::unordered_set<int> may_a(x.begin(), x.end()), may_b(y.begin(), y.end());
    for (auto& [place, both] : whole) AlignPlace(&both.first, &both.second, may_a, may_b);
  }
  void AlignPlace(Ids* x, Ids* y, const std::unordered_set<int>& may_a,
                  const std::unordered_set<int>& may_b) {
    std::stable_sort(x->begin(), x->end(), [&](int p, int q) { return A(p).firing < A(q).firing; });
    std::stable_sort(y->begin(), y->end(), [&](int p, int q) { return B(p).firing < B(q).firing; });
    std::unordered_map<int, std::size_t> place_in_y;
    for (std::size_t m = 0; m < y->size(); ++m) place_in_y[(*y)[m]] = m;
    Ids gap_x, gap_y;
    std::size_t m = 0;
    for (const int i : *x) {
      if (FreeA(i)) {
        if (may_a.contains(i)) gap_x.push_back(i);
        continue;
      }
      const auto anchor = place_in_y.find(OfA(i));
      if (anchor == place_in_y.end() || anchor->second < m) continue;
      for (; m < anchor->second; ++m) {
        if (FreeB((*y)[m]) && may_b.contains((*y)[m])) gap_y.push_back((*y)[m]);
      }
      ++m;
      AlignGap(gap_x, gap_y);
      gap_x.clear(), gap_y.clear();
    }
    for (; m < y->size(); ++m) {
      if (FreeB((*y)[m]) && may_b.contains((*y)[m])) gap_y.push_back((*y)[m]);
    }
    AlignGap(gap_x, gap_y);
  }
  void AlignGap(const Ids& x, const Ids& y) {
    if (x.size() == y.size() || x.size() * y.size() > kMostCells) {
      for (std::size_t n = 0; n < std::min(x.size(), y.size()); ++n) Pair(x[n], y[n]);
      return;
    }
    const std::size_t columns = y.size() + 1;
    std::vector<double> best((x.size() + 1) * columns, 0), alike(x.size() * y.size());
    for (std::size_t n = x.size(); n-- > 0;) {
      for (std::size_t m = y.size(); m-- > 0;) {
        const double likeness = Likeness(A(x[n]), B(y[m]));
        alike[n * y.size() + m] = likeness;
        best[n * columns + m] = std::max({best[(n + 1) * columns + m], best[n * columns + m + 1],
                                          likeness + best[(n + 1) * columns + m + 1]});
      }
    }
    for (std::size_t n = 0, m = 0; n < x.size() && m < y.size();) {
      if (best[n * columns + m] <= alike[n * y.size() + m] + best[(n + 1) * columns + m + 1])
        Pair(x[n++], y[m++]);
      else if (best[(n + 1) * columns + m] >= best[n * columns + m + 1])
        ++n;
      else
        ++m;
    }
  }
  // Of two that come from the same statement.
  static double Likeness(const Subject& x, const Subject& y) {
    double likeness = 0.1;
    if (x.name == y.name) likeness += 1;
    if (model::TypeOf(*x.element) != model::TypeOf(*y.element)) return likeness;
    likeness += 2;
    if (ShapeHash(*x.element) == ShapeHash(*y.element)) likeness += 1;
    const geom::Box p = model::BoundingBox(*x.element), q = model::BoundingBox(*y.element);
    if (!p.empty() && !q.empty()) likeness += 1 / (1 + (p.centre() - q.centre()).norm());
    return likeness;
  }

  // Those whose statements are not in the other script at all: the same geometry, or the same shape
  // made by the same command with the same settings.
  void MatchByShape(const Ids& x, const Ids& y) {
    Ids left_a, left_b;
    std::copy_if(x.begin(), x.end(), std::back_inserter(left_a),
                 [&](int i) { return FreeA(i) && !places_.HasCounterpartA(A(i)); });
    std::copy_if(y.begin(), y.end(), std::back_inserter(left_b),
                 [&](int j) { return FreeB(j) && !places_.HasCounterpartB(B(j)); });
    if (left_a.empty() || left_b.empty()) return;
    PairByKey(left_a, left_b, [](const Subject& s) { return GeometryHash(*s.element); });
    PairByKey(left_a, left_b, [](const Subject& s) {
      model::Hasher hasher;
      if (ShapePoints(*s.element) < kFewestPoints) return model::Hash128{};
      model::AddToHash(hasher, *s.element->attributes);
      return hasher.Hash(ShapeHash(*s.element)).Finish();
    });
  }
  template <class Key>
  void PairByKey(const Ids& x, const Ids& y, Key key) {
    std::unordered_map<model::Hash128, Ids, HashOfHash> waiting;
    for (auto j = y.rbegin(); j != y.rend(); ++j) {
      if (FreeB(*j)) waiting[key(B(*j))].push_back(*j);
    }
    for (const int i : x) {
      if (!FreeA(i)) continue;
      const model::Hash128 hash = key(A(i));
      const auto found = waiting.find(hash);
      if (hash == model::Hash128{} || found == waiting.end() || found->second.empty()) continue;
      Pair(i, found->second.back());
      found->second.pop_back();
    }
  }

  const PlaceMap& places_;
  ElementMatch match_;
  std::vector<Place> places_a_, places_b_;
  std::vector<Ids> members_a_, members_b_;
};

ElementMatch MatchInThisOrder(const RunRecord& a, const StatementTree& tree_a, const RunRecord& b,
                              const StatementTree& tree_b) {
  Subjects x(a, tree_a), y(b, tree_b);
  const PlaceMap places(tree_a, tree_b, MatchStatements(tree_a, tree_b), x, y);
  return ElementMatcher(std::move(x), std::move(y), places).Run();
}

}  // namespace

ElementMatch MatchElements(const RunRecord& a, const RunRecord& b) {
  constexpr int kDepth = 100'000;  // both were parsed before, within their own limits
  const StatementTree tree_a = MakeStatementTree(*a.result.sources, kDepth);
  const StatementTree tree_b = MakeStatementTree(*b.result.sources, kDepth);
  // Always matched in the same direction, so that the diff of b and a is that of a and b mirrored.
  const auto key = [](const RunRecord& record, const StatementTree& tree) {
    return std::pair{tree.statements[0].hash, record.result.outcome.state.model.hash};
  };
  if (key(a, tree_a) <= key(b, tree_b)) return MatchInThisOrder(a, tree_a, b, tree_b);
  ElementMatch match = MatchInThisOrder(b, tree_b, a, tree_a);
  std::swap(match.a, match.b);
  std::swap(match.b_of_a, match.a_of_b);
  return match;
}

}  // namespace tranos::session
