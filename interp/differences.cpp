// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/differences.h"

#include <map>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Element;
using model::ElementPtr;
using model::Moved;
using model::SourceId;
using model::Value;

namespace {

// What was read with one source to either side.
struct Side {
  SourceId source;
  double step;
  Value forward, back;
};

// A difference below this share of the number is rounding.
constexpr double kRounding = 1e-13;

Value WithDerivatives(const Value& base, std::span<const Side> sides) {
  std::map<SourceId, double> slopes;
  if (const model::Derivatives* own = base.derivatives()) {
    for (const auto& [source, slope] : own->terms) slopes[source] = slope;
  }
  for (const Side& side : sides) {
    if (!side.forward.is_number() || !side.back.is_number()) continue;
    const double difference = side.forward.number() - side.back.number();
    if (std::abs(difference) <= kRounding * std::abs(base.number())) continue;
    slopes[side.source] += difference / (2 * side.step);
  }
  if (slopes.empty()) return base;
  return Value::Uncertain({base.number(), {{slopes.begin(), slopes.end()}}}, base.dimension());
}

// A part of a placed element hangs on what the placement does; an element of the model on its own.
Value WithSides(const Value& base, std::span<const Side> sides) {
  const Element& part = *base.element();
  if (part.id != model::kNoElement) return base;
  std::vector<Moved> moved;
  for (const Side& side : sides) {
    if (!side.forward.is_element() || !side.back.is_element()) continue;
    moved.push_back(
        {side.source, side.step, side.forward.element()->geometry, side.back.element()->geometry});
  }
  return Value::OfElement(model::WithMoved(part, std::move(moved)));
}

Value Differenced(const Value& base, std::span<const Side> sides);

// One item of a list or record, as each side has it.
template <class Item>
Value ItemDifferenced(const Value& base, std::span<const Side> sides, const Item& item) {
  std::vector<Side> items;
  for (const Side& side : sides) {
    const Value *forward = item(side.forward), *back = item(side.back);
    if (forward && back) items.push_back({side.source, side.step, *forward, *back});
  }
  return Differenced(base, items);
}

Value Differenced(const Value& base, std::span<const Side> sides) {
  if (base.is_number()) return WithDerivatives(base, sides);
  if (base.is_element()) return WithSides(base, sides);
  if (base.is_list()) {
    std::vector<Value> items;
    for (std::size_t i = 0; i < base.list().size(); ++i) {
      items.push_back(ItemDifferenced(base.list()[i], sides, [&](const Value& side) {
        return side.is_list() && side.list().size() == base.list().size() ? &side.list()[i]
                                                                          : nullptr;
      }));
    }
    return Value::List(std::move(items));
  }
  if (base.kind() == Value::Kind::kRecord) {
    model::Record record{base.record().type, {}};
    for (const auto& [name, member] : base.record().members) {
      record.members.emplace_back(
          name, ItemDifferenced(member, sides, [&, of = name](const Value& side) {
            return side.kind() == Value::Kind::kRecord ? side.record().Find(of) : nullptr;
          }));
    }
    return Value::OfRecord(std::move(record));
  }
  return base;
}

// The element to one side. It stands in no model, so that it is taken as it is.
ElementPtr Beside(const Element& element, const model::Geometry& geometry) {
  return model::WithId(*model::WithGeometry(element, geometry), model::kNoElement);
}

}  // namespace

Value ReadOff(const ElementPtr& element, const std::function<Value(const ElementPtr&)>& read) {
  const Value base = read(element);
  if (!element->moved) return base;
  std::vector<Side> sides;
  for (const auto& [source, step, forward, back] : *element->moved) {
    sides.push_back({source, step, read(Beside(*element, forward)), read(Beside(*element, back))});
  }
  return Differenced(base, sides);
}

Value CallBuiltin(const Builtin& row, const CallContext& context, Arguments arguments) {
  const Value base = row.call(context, arguments);
  std::map<SourceId, double> steps;
  std::vector<ElementPtr> elements(arguments.size());
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!arguments[i].is_element()) continue;
    elements[i] = CurrentElement(*context.state, arguments[i].element());
    if (!elements[i]->moved) continue;
    for (const Moved& moved : *elements[i]->moved) steps[moved.source] = moved.step;
  }
  if (steps.empty()) return base;
  std::vector<Side> sides;
  for (const auto& [source, step] : steps) {
    std::vector<Value> ahead(arguments.begin(), arguments.end()), behind = ahead;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (!elements[i] || !elements[i]->moved) continue;
      for (const Moved& moved : *elements[i]->moved) {
        if (moved.source != source) continue;
        ahead[i] = Value::OfElement(Beside(*elements[i], moved.forward));
        behind[i] = Value::OfElement(Beside(*elements[i], moved.back));
      }
    }
    sides.push_back({source, step, row.call(context, ahead), row.call(context, behind)});
  }
  return Differenced(base, sides);
}

}  // namespace tranos::interp
