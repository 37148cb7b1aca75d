// SPDX-License-Identifier: GPL-3.0-or-later
// Placing a defined element: its body is run once for the same arguments, and placed any number of
// times.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "interp/machine.h"

namespace tranos::interp {

using geom::Vec3;
using model::Hash128;
using model::Value;

namespace {

// Sets a variable for as long as it lives.
template <class T>
class Lend {
 public:
  Lend(T* slot, T value) : slot_(slot), before_(std::exchange(*slot, std::move(value))) {}
  ~Lend() { *slot_ = std::move(before_); }
  Lend(const Lend&) = delete;
  Lend& operator=(const Lend&) = delete;

 private:
  T* slot_;
  T before_;
};

}  // namespace

// What a unit reads of the activations around it, through everything it calls.
const std::vector<std::pair<std::uint32_t, std::uint32_t>>& Machine::OuterOf(std::uint32_t unit) {
  const auto [found, is_new] = outer_.try_emplace(unit);
  if (!is_new) return found->second;
  std::vector<bool> seen(program_.units.size());
  std::vector<std::uint32_t> pending{unit};
  auto& names = outer_names_[unit];
  while (!pending.empty()) {
    const std::uint32_t at = pending.back();
    pending.pop_back();
    if (seen[at]) continue;
    seen[at] = true;
    const CodeUnit& code = program_.units[at];
    found->second.insert(found->second.end(), code.outer.begin(), code.outer.end());
    names.insert(names.end(), code.outer_names.begin(), code.outer_names.end());
    pending.insert(pending.end(), code.calls.begin(), code.calls.end());
  }
  for (auto* list : {&found->second, &names}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  return found->second;
}

namespace {

// Two elements of equal content may still differ in what they can be asked for: an instance's
// parameters and interfaces, a group's names. Prototypes live as long as the run, so their
// addresses tell them apart.
void AddMembers(model::Hasher& hasher, const model::Element& element) {
  if (const auto* instance = std::get_if<model::InstancePtr>(&element.geometry)) {
    hasher.Integer(
        static_cast<std::int64_t>(reinterpret_cast<std::intptr_t>((*instance)->prototype.get())));
  } else if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    for (const model::NamedElements& named : (*group)->names) {
      hasher.Text(named.name);
      for (const model::ElementPtr& part : named.elements) hasher.Hash(part->hash);
    }
    for (const model::ElementPtr& member : (*group)->members) AddMembers(hasher, *member);
  }
}
void AddMembers(model::Hasher& hasher, const Value& value) {
  if (!value.holds_elements()) return;
  if (value.is_element()) return AddMembers(hasher, *value.element());
  for (const Value& item : value.list()) AddMembers(hasher, item);
}

// What puts the element's own interface where its origin would be: the axes against one another, as
// the foot of what stands on something looks into it, and the directions alike.
geom::Affine OriginFromInterface(const model::Prototype& prototype, const Placement& placement) {
  std::string names;
  for (const model::Interface& interface : prototype.interfaces) {
    if (interface.name == placement.own) {
      geom::Affine turned = geom::Affine::Identity();
      turned.linear().diagonal() = geom::Vec3(1, -1, -1);
      return turned * interface.frame.WorldFromFrame().inverse();
    }
    names += (names.empty() ? "" : ", ") + interface.name;
  }
  Fail(Code::kUnknownMember, placement.at,
       "`" + Printable(prototype.words) + "` has no interface `" + Printable(placement.own) + "`",
       "", names.empty() ? "leave it out: its origin is put there" : "it has " + names);
}

}  // namespace

// Arguments and everything else that the body can depend on.
Hash128 Machine::KeyOf(const Definition& definition, const Registers& registers, Span span) {
  model::Hasher hasher;
  for (std::size_t i = 0; i < definition.parameters.size(); ++i) {
    AddToHash(hasher, registers[i]);
    AddMembers(hasher, registers[i]);
  }
  for (const auto& [unit, reg] : OuterOf(definition.unit)) {
    const Activation& activation = innermost_[unit];
    if (!activation.registers) continue;
    const Value& value = activation.registers[reg];
    const Value shown = Detached(value, span);
    AddToHash(hasher, shown);
    AddMembers(hasher, shown);
    // A function value has no content to hash: only itself is the same.
    if (value.kind() == Value::Kind::kClosure) {
      hasher.Integer(static_cast<std::int64_t>(
          static_cast<const ClosureCode*>(value.closure().code.get())->serial));
    }
  }
  for (const auto& [scope, index] : outer_names_[definition.unit]) {
    const ScopePlace& place = places_[scope];
    if (!place.stage || scope == definition.scope) continue;
    const auto& ids = place.stage->NamesOut(place.stage->groups() - place.depth)[index].ids;
    ids.ForEach([&](model::ElementId id) {
      const model::ElementPtr element = place.stage->state().model.Current(id);
      if (!element) return;
      hasher.Hash(element->hash);
      AddMembers(hasher, *element);
    });
  }
  return hasher.Finish();
}

model::ElementPtr Machine::Place(const Placement& placement, const model::State& state) {
  const Definition& definition = *placement.definition;
  const CodeUnit& unit = program_.units[definition.unit];
  if (definition_depth_ >= budget_.limits.depth) {
    Fail(Code::kDepthLimit, placement.span,
         "definitions are nested more than " + std::to_string(budget_.limits.depth) + " deep", "",
         "does the definition place itself without end? --limit depth=N raises the limit");
  }
  budget_.ChargeSteps(1, placement.span);
  Registers registers(unit.registers);
  for (std::size_t i = 0; i < definition.parameters.size(); ++i) {
    const DefinedParameter& parameter = definition.parameters[i];
    registers[i] = placement.arguments[i];
    for (const auto& [name, measure] : placement.measures) {
      if (name != parameter.name) continue;
      const Value value = Convert(measure, parameter.type, program_.measures[0], name);
      if (registers[i].is_none()) {
        registers[i] = value;
      } else if (!model::Same(registers[i], value)) {
        outcome_.diagnostics.Add(
            {Code::kInterfaceDiffers, placement.argument_spans[i],
             "`" + name + "` is " + Format(registers[i], program_.measures[0], -1) +
                 ", but the interface says " + Format(value, program_.measures[0], -1),
             "", "leave `" + name + "=` out to take the interface's"});
      }
    }
  }
  auto instance = std::make_shared<model::Instance>();
  try {
    instance->prototype = PrototypeOf(placement, std::move(registers));
  } catch (RunFailure& failure) {
    // Where another file goes wrong, the placement is what the user can change.
    std::vector<Note>& notes = failure.diagnostic.notes;
    const std::uint32_t at = notes.empty() || failure.diagnostic.span.file == placement.span.file
                                 ? failure.diagnostic.span.file
                                 : notes.back().span.file;
    if (at != placement.span.file) notes.push_back({placement.span, "placed here"});
    throw;
  }
  instance->world_from_prototype = placement.world_from_element;
  if (!placement.own.empty()) {
    instance->world_from_prototype =
        placement.world_from_element * OriginFromInterface(*instance->prototype, placement);
  }
  return NewElement(state, model::InstancePtr(std::move(instance)));
}

// What the definition builds of these arguments: built once.
model::PrototypePtr Machine::PrototypeOf(const Placement& placement, Registers registers) {
  const Definition& definition = *placement.definition;
  Lend<const Placement*> placing(&placing_, &placement);
  ++definition_depth_;
  Execute(definition.unit, registers.data(), 0, stage_);  // the parameters
  for (std::size_t i = 0; i < definition.parameters.size(); ++i) {
    registers[i] = Detached(registers[i], placement.span);
  }
  const auto key = std::make_pair(definition.unit, KeyOf(definition, registers, placement.span));
  auto found = prototypes_.find(key);
  if (found == prototypes_.end()) {
    found = prototypes_.emplace(key, Build(definition, std::move(registers), placement.span)).first;
  }
  --definition_depth_;
  return found->second;
}

model::PrototypePtr Machine::Build(const Definition& definition, Registers registers, Span span) {
  Stage stage(LinksFor(false), false);
  std::vector<model::Interface> interfaces;
  model::Prototype prototype;
  for (std::size_t i = 0; i < definition.parameters.size(); ++i) {
    prototype.parameters.emplace_back(definition.parameters[i].name, registers[i]);
  }
  {
    Lend<Stage*> on_stage(&stage_, &stage);
    Lend<const Placement*> nothing_placed(&placing_, nullptr);
    Lend<std::vector<model::Interface>*> lent(&interfaces_, &interfaces);
    Lend<ScopePlace> place(&places_[definition.scope], {&stage, 0});
    Lend<std::vector<std::uint32_t>> turns(&turns_, {});
    Execute(definition.unit, registers.data(), program_.units[definition.unit].body, &stage);
  }
  prototype.words = definition.words.substr(definition.words.find(' ') + 1);
  prototype.names = stage.NamesOf(definition.scope);
  // What is named `void` is no part of what is built: it is taken out of the wall it is placed on.
  std::unordered_set<model::ElementId> voids;
  for (const model::NamedElements& named : prototype.names) {
    if (named.name != "void") continue;
    for (const model::ElementPtr& part : named.elements) voids.insert(part->id);
  }
  stage.state().model.ForEach([&](const model::ElementPtr& part) {
    if (!voids.contains(part->id)) prototype.parts.push_back(part);
  });
  if (prototype.parts.empty() && voids.empty()) {
    Fail(Code::kNothingMade, span, "`" + definition.words + "` makes nothing", "", "",
         {{definition.span, "its body leaves no element in the model"}});
  }
  prototype.interfaces = std::move(interfaces);
  return model::MakePrototype(std::move(prototype));
}

void Machine::NoteInterface(const Instruction& i, const CodeUnit& unit, const Value* r, Span span) {
  model::Interface interface;
  interface.name = unit.constants[i.a & ~kConstantBit].string();
  Vec3 axis = Vec3::UnitZ(), direction = Vec3::Zero();
  for (std::uint32_t n = 0; n < i.c; ++n) {
    const std::string& key = r[i.b + 2 * n].string();
    const Value& value = r[i.b + 2 * n + 1];
    if (key == "at")
      interface.frame.origin = PointOf(value);
    else if (key == "axis")
      axis = PointOf(value);
    else if (key == "dir")
      direction = PointOf(value);
    else if (value.holds_elements() || value.kind() == Value::Kind::kClosure ||
             value.kind() == Value::Kind::kRecord) {
      Fail(Code::kWrongType, span, "the measure `" + key + "` is " + Describe(value),
           "expected a number such as 4.5m",
           "name the part with `as`: it is then a member of the placed element");
    } else {
      interface.measures.emplace_back(key, value);
    }
  }
  if (!(axis.norm() > 0))
    Fail(Code::kDegenerate, span, "the axis of the interface has no direction");
  axis.normalize();
  Vec3 x = direction - direction.dot(axis) * axis;
  if (!(x.norm() > 1e-9)) {
    const Vec3 aside =
        std::abs(axis.z()) > 0.999 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ().cross(axis));
    x = aside - aside.dot(axis) * axis;
  }
  interface.frame.x = x.normalized();
  interface.frame.y = axis.cross(interface.frame.x);
  for (const model::Interface& known : *interfaces_) {
    if (known.name == interface.name) {
      Fail(Code::kBoundTwice, span,
           "the definition has an interface `" + interface.name + "` already");
    }
  }
  interfaces_->push_back(std::move(interface));
}

}  // namespace tranos::interp
