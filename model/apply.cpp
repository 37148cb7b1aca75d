// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <unordered_set>

#include "model/edit.h"

namespace tranos::model {

namespace {

// One edit on its way into a state. Every change of an entry goes through Put, which keeps the
// hashes right.
class Application {
 public:
  Application(State& state, const Edit& edit) : state_(state), edit_(edit) {}

  std::vector<ElementId> Run() {
    for (const ElementId id : edit_.deleted) Delete(id);
    for (const ElementId id : edit_.consumed) Consume(id);
    AddAll();
    for (const ElementPtr& element : edit_.replaced) Replace(element);
    for (const ElementPtr& element : edit_.released) Release(element);
    UpdateDrawing();
    return std::move(made_or_changed_);
  }

 private:
  Entries& entries() { return state_.model.entries; }

  void Count(const Entry& entry) {
    if (entry.standing != Standing::kInModel) return;
    state_.model.hash = state_.model.hash + entry.element->hash;
    ++state_.model.live;
  }
  void Discount(const Entry& entry) {
    if (entry.standing != Standing::kInModel) return;
    state_.model.hash = state_.model.hash - entry.element->hash;
    --state_.model.live;
  }
  void Append(Entry entry) {
    Count(entry);
    entries().Append(std::move(entry));
  }
  void Put(ElementId id, Entry entry) {
    const Entry& before = entries()[id];
    if (touched_.size() <= kFewTouched) touched_.push_back(id);
    Discount(before);
    Count(entry);
    state_.drawing.names.Follow(id, ContentOf(before), ContentOf(entry));
    entries().Set(id, std::move(entry));
  }

  void Delete(ElementId id) {
    LeaveOwner(id);
    DeleteWithMembers(id);
  }
  void DeleteWithMembers(ElementId id) {
    const Entry before = entries()[id];
    if (!before.element) return;
    Put(id, {nullptr, Standing::kDeleted, before.owner});
    if (const auto* group = std::get_if<GroupPtr>(&before.element->geometry)) {
      for (const ElementPtr& member : (*group)->members) {
        if (IsOwned(*member, id)) DeleteWithMembers(member->id);
      }
    }
  }
  void Consume(ElementId id) {
    LeaveOwner(id);
    Put(id, {entries()[id].element, Standing::kConsumed, kNoElement});
  }

  bool IsOwned(const Element& member, ElementId group) {
    return member.id < entries().size() && entries()[member.id].owner == group;
  }
  // A member that is consumed or deleted by itself leaves the group that it stands in.
  void LeaveOwner(ElementId id) {
    const Entry& entry = entries()[id];
    if (entry.standing == Standing::kMember) ChangeInOwner(entry.owner, id, nullptr);
  }
  // The group `owner`, and those around it, with `member` in the place of its member `id`.
  void ChangeInOwner(ElementId owner, ElementId id, const ElementPtr& member) {
    const Entry before = entries()[owner];
    const auto& group = *std::get<GroupPtr>(before.element->geometry);
    const ElementPtr changed = WithGeometry(
        *before.element,
        MapMembers(group, [&](const ElementPtr& old) { return old->id == id ? member : old; }));
    Put(owner, {changed, before.standing, before.owner});
    if (before.standing == Standing::kMember) ChangeInOwner(before.owner, owner, changed);
  }

  void AddAll() {
    const auto first = static_cast<ElementId>(entries().size());
    next_id_ = first + static_cast<ElementId>(edit_.added.size());
    for (const ElementId id : edit_.grouped) {
      Put(id, {entries()[id].element, Standing::kMember, first});
    }
    ElementId id = first;
    for (const ElementPtr& element : edit_.added) {
      Append({WithMembersEntered(element->id == id ? element : WithId(*element, id)),
              Standing::kInModel, kNoElement});
      made_or_changed_.push_back(id++);
    }
    AppendNewMembers();
  }
  // A group's members have entries too. Those that the group owns are brought up to date; others
  // (of a copied group, say) are new elements and get ids of their own, after those of `added`.
  ElementPtr WithMembersEntered(const ElementPtr& element) {
    const auto* group = std::get_if<GroupPtr>(&element->geometry);
    if (!group) return element;
    const auto& members = (*group)->members;
    const bool all_owned = std::all_of(members.begin(), members.end(), [&](const ElementPtr& m) {
      return IsOwned(*m, element->id);
    });
    const auto enter = [&](const ElementPtr& member) { return Enter(member, element->id); };
    if (all_owned) {
      for (const ElementPtr& member : members) enter(member);
      return element;
    }
    auto copy = std::make_shared<Element>(*element);  // ids are no part of the hash
    copy->geometry = MapMembers(**group, enter);
    return copy;
  }
  ElementPtr Enter(const ElementPtr& member, ElementId owner) {
    if (IsOwned(*member, owner)) {
      const Entry& entry = entries()[member->id];
      if (entry.element != member || entry.standing != Standing::kMember) {
        Put(member->id, {member, Standing::kMember, owner});
        WithMembersEntered(member);
      }
      return member;
    }
    const std::size_t slot = new_members_.size();
    new_members_.push_back({nullptr, Standing::kMember, owner});
    const ElementPtr entered = WithMembersEntered(WithId(*member, next_id_++));
    new_members_[slot].element = entered;
    return entered;
  }
  void AppendNewMembers() {
    for (Entry& entry : new_members_) Append(std::move(entry));
    new_members_.clear();
  }

  void Replace(const ElementPtr& element) {
    const Entry before = entries()[element->id];
    const ElementPtr entered = EnterExisting(element);
    Put(element->id, {entered, before.standing, before.owner});
    if (before.standing == Standing::kMember) ChangeInOwner(before.owner, element->id, entered);
    made_or_changed_.push_back(element->id);
  }
  void Release(const ElementPtr& element) {
    Put(element->id, {EnterExisting(element), Standing::kInModel, kNoElement});
    made_or_changed_.push_back(element->id);
  }
  ElementPtr EnterExisting(const ElementPtr& element) {
    next_id_ = static_cast<ElementId>(entries().size());
    const ElementPtr entered = WithMembersEntered(element);
    AppendNewMembers();
    return entered;
  }

  void UpdateDrawing() {
    Drawing& drawing = state_.drawing;
    if (edit_.selection) {
      drawing.selection = StillInModel(Resolved(*edit_.selection));
      drawing.selection.Rehash(entries());
    } else if (Touches(drawing.selection)) {
      drawing.selection = StillInModel(drawing.selection);
      drawing.selection.Rehash(entries());
    }
    if (!made_or_changed_.empty()) {
      std::vector<ElementId> last = made_or_changed_;
      std::erase_if(last, [&](ElementId id) {
        return std::find(edit_.following.begin(), edit_.following.end(), id) !=
               edit_.following.end();
      });
      drawing.last = Selection(std::move(last));
      drawing.last.Rehash(entries());
    } else if (Touches(drawing.last)) {
      drawing.last.Rehash(entries());
    }
    if (edit_.settings) drawing.settings = *edit_.settings;
    if (edit_.view) drawing.view = std::make_shared<const View>(*edit_.view);
    if (edit_.last_point) drawing.last_point = *edit_.last_point;
    if (edit_.photograph) drawing.photograph = Resolved(*edit_.photograph);
    if (edit_.hidden_levels) {
      state_.model.hidden_levels =
          std::make_shared<const std::vector<std::string>>(*edit_.hidden_levels);
    }
  }
  // Whether it may hold what has changed: looked up for a few, taken for granted of many.
  bool Touches(const Selection& selection) const {
    return touched_.size() > kFewTouched ||
           std::any_of(touched_.begin(), touched_.end(),
                       [&](ElementId id) { return selection.Contains(id); });
  }
  Selection Resolved(const Selection& selection) {
    std::vector<ElementId> ids(selection.begin(), selection.end());
    for (ElementId& id : ids) id = Resolved(id);
    return ids;
  }
  ElementId Resolved(ElementId id) const {
    return id < kAddedBase ? id : id - kAddedBase + static_cast<ElementId>(first_added_);
  }
  Selection StillInModel(const Selection& selection) {
    const auto stands = [&](ElementId id) { return state_.model.InModel(id); };
    if (std::all_of(selection.begin(), selection.end(), stands)) return selection;
    std::vector<ElementId> ids;
    std::copy_if(selection.begin(), selection.end(), std::back_inserter(ids), stands);
    return ids;
  }

  static constexpr std::size_t kFewTouched = 8;
  State& state_;
  const Edit& edit_;
  const std::size_t first_added_ = state_.model.entries.size();
  ElementId next_id_ = 0;
  std::vector<Entry> new_members_;  // whose ids are next in line
  std::vector<ElementId> made_or_changed_;
  // Entries that were there before and have changed; of many no more than tell that they are many.
  std::vector<ElementId> touched_;
};

}  // namespace

Applied Apply(State state, const Edit& edit) {
  Applied applied{std::move(state), {}};
  applied.made_or_changed = Application(applied.state, edit).Run();
  return applied;
}

}  // namespace tranos::model
