// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/deviations.h"

#include <algorithm>
#include <set>

#include "interp/commands/photographs.h"

namespace tranos::interp {

using model::ElementId;
using model::ElementPtr;
using model::Moved;
using model::SourceId;
using model::State;
using model::Value;

namespace {

template <class F>
void ForEachElement(const Value& value, const F& f) {
  if (value.is_element()) return f(value.element());
  if (!value.holds_elements()) return;
  for (const Value& item : value.list()) ForEachElement(item, f);
}

// Whether it is a number, a point (one deep) or points that hang on sources.
bool IsUncertain(const Value& value, int deep = 2) {
  if (!value.is_list()) return value.derivatives() != nullptr;
  return deep > 0 && std::any_of(value.list().begin(), value.list().end(),
                                 [&](const Value& item) { return IsUncertain(item, deep - 1); });
}

void AddSources(const Value& value, std::set<SourceId>* sources) {
  if (value.is_list()) {
    for (const Value& item : value.list()) AddSources(item, sources);
  } else if (const model::Derivatives* derivatives = value.derivatives()) {
    for (const auto& [source, slope] : derivatives->terms) sources->insert(source);
  }
}

// What a firing goes by, with one of its sources to one side.
class Beside {
 public:
  Beside(const Command& row, const State& before, const Answers& answers,
         std::span<const PointTerms> terms)
      : row_(row), before_(before), answers_(answers), terms_(terms) {
    for (const PointTerms& point : terms) {
      for (const auto& [source, term] : point) sources_.insert(source);
    }
    for (const ElementPtr& element : answers.chosen) Note(element);
    for (const auto& [key, value] : answers.keys) {
      if (IsUncertain(value)) AddSources(value, &sources_);
      ForEachElement(value, [&](const ElementPtr& given) {
        const ElementPtr current = before.model.Current(given->id);
        Note(current ? current : given);
      });
    }
    for (const Key& key : row.keys) {  // what is known by a name is a facade
      if (key.type != Type::kName || !answers.Has(key.name)) continue;
      if (const auto facade = model::FindFacade(before.model, answers.Text(key.name))) Note(facade);
    }
    if (row.dots) {
      if (const auto photograph = CameraMeant(before, answers)) NoteCamera(*photograph);
      if (const auto facade = FacadeMeant(before, answers)) Note(*facade);
    }
  }

  const std::set<SourceId>& sources() const { return sources_; }

  CommandResult Fired(SourceId source, double step) const {
    State state = before_;
    Answers answers = answers_;
    for (std::size_t i = 0; i < answers.points.size() && i < terms_.size(); ++i) {
      for (const auto& [of, term] : terms_[i]) {
        if (of == source) answers.points[i] += step * term;
      }
    }
    for (const ElementPtr& element : hanging_) {
      if (element->id >= state.model.entries.size()) continue;
      model::Entry entry = state.model.entries[element->id];
      entry.element = Moved(element, source, step);
      state.model.entries.Set(element->id, entry);
    }
    if (camera_) {
      model::Entry entry = state.model.entries[camera_->id];
      entry.element = MovedCamera(source, step);
      state.model.entries.Set(camera_->id, entry);
    }
    for (ElementPtr& element : answers.chosen) element = Moved(element, source, step);
    for (auto& [key, value] : answers.keys) value = Moved(value, source, step);
    return row_.execute(state, answers);
  }

 private:
  void Note(const ElementPtr& element) {
    if (!element->moved) return;
    hanging_.push_back(element);
    for (const model::Moved& moved : *element->moved) sources_.insert(moved.source);
  }

  void NoteCamera(const ElementPtr& photograph) {
    camera_ = photograph;
    const Eigen::MatrixXd& deviations = PhotographOf(*photograph).estimate->deviations;
    for (Eigen::Index j = 0; j < deviations.cols(); ++j) {
      if (!deviations.block<camera::kParameters, 1>(0, j).isZero(0))
        sources_.insert(static_cast<SourceId>(j));
    }
  }

  ElementPtr MovedCamera(SourceId source, double step) const {
    model::Photograph photograph = PhotographOf(*camera_);
    auto estimate = std::make_shared<camera::Estimate>(*photograph.estimate);
    if (source < estimate->deviations.cols()) {
      estimate->camera.parameters +=
          step * estimate->deviations.block<camera::kParameters, 1>(0, source);
    }
    photograph.estimate = std::move(estimate);
    return WithPhotograph(*camera_, std::move(photograph));
  }

  static ElementPtr Moved(const ElementPtr& element, SourceId source, double step) {
    if (!element->moved) return element;
    for (const model::Moved& moved : *element->moved) {
      if (moved.source != source) continue;
      return model::WithGeometry(*element, step > 0 ? moved.forward : moved.back);
    }
    return element;
  }

  static Value Moved(const Value& value, SourceId source, double step) {
    if (value.is_element()) return Value::OfElement(Moved(value.element(), source, step));
    if (const model::Derivatives* derivatives = value.derivatives()) {
      double number = value.number();
      for (const auto& [of, slope] : derivatives->terms) number += of == source ? step * slope : 0;
      return Value::Number(number, value.dimension());
    }
    if (!value.holds_elements() && !IsUncertain(value)) return value;
    std::vector<Value> items;
    for (const Value& item : value.list()) items.push_back(Moved(item, source, step));
    return Value::List(std::move(items));
  }

  const Command& row_;
  const State& before_;
  const Answers& answers_;
  std::span<const PointTerms> terms_;
  std::set<SourceId> sources_;
  std::vector<ElementPtr> hanging_;
  ElementPtr camera_;
};

bool AreAlike(const std::vector<ElementPtr>& a, const std::vector<ElementPtr>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x->geometry.index() == y->geometry.index();
  });
}

}  // namespace

std::optional<int> CarryDeviations(const Command& row, const State& before, const Answers& answers,
                                   std::span<const PointTerms> terms, const SourceList& sources,
                                   model::Edit* edit) {
  // An orthophoto is a picture that lies where it was asked for.
  const auto is_picture = [](const ElementPtr& element) {
    return std::holds_alternative<model::OrthophotoPtr>(element->geometry);
  };
  const bool makes = !std::ranges::all_of(edit->added, is_picture) || !edit->replaced.empty();
  if (!makes || !row.execute || row.informs) return 0;
  const Beside beside(row, before, answers, terms);
  if (beside.sources().empty()) return 0;
  std::vector<std::vector<Moved>> added(edit->added.size()), replaced(edit->replaced.size());
  int times = 0;
  for (const SourceId source : beside.sources()) {
    if (source >= sources.size() || !(sources[source].sigma > 0)) continue;
    const double step = model::kMovedBy * sources[source].sigma;
    const CommandResult forward = beside.Fired(source, step), back = beside.Fired(source, -step);
    times += 2;
    for (const CommandResult* side : {&forward, &back}) {
      if (!*side || !AreAlike((*side)->edit.added, edit->added) ||
          !AreAlike((*side)->edit.replaced, edit->replaced)) {
        return std::nullopt;
      }
    }
    const auto note = [&](auto* to, const auto& ahead, const auto& behind) {
      for (std::size_t i = 0; i < to->size(); ++i) {
        if (ahead[i]->hash == behind[i]->hash) continue;
        (*to)[i].push_back({source, step, ahead[i]->geometry, behind[i]->geometry});
      }
    };
    note(&added, forward->edit.added, back->edit.added);
    note(&replaced, forward->edit.replaced, back->edit.replaced);
  }
  for (std::size_t i = 0; i < added.size(); ++i)
    edit->added[i] = model::WithMoved(*edit->added[i], std::move(added[i]));
  for (std::size_t i = 0; i < replaced.size(); ++i)
    edit->replaced[i] = model::WithMoved(*edit->replaced[i], std::move(replaced[i]));
  return times;
}

}  // namespace tranos::interp
