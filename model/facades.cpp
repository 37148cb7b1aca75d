// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/facades.h"

namespace tranos::model {

namespace {

template <class F>
void ForEachFacade(const Model& model, F&& f) {
  model.ForEach([&](const ElementPtr& element) {
    if (std::holds_alternative<FacadePtr>(element->geometry)) f(element);
  });
}

}  // namespace

const Facade& FacadeOf(const Element& element) { return *std::get<FacadePtr>(element.geometry); }

ElementPtr FindFacade(const Model& model, std::string_view name) {
  ElementPtr found;
  ForEachFacade(model, [&](const ElementPtr& element) {
    if (FacadeOf(*element).name == name) found = element;
  });
  return found;
}

std::vector<std::string> FacadeNames(const Model& model) {
  std::vector<std::string> names;
  ForEachFacade(model,
                [&](const ElementPtr& element) { names.push_back(FacadeOf(*element).name); });
  return names;
}

}  // namespace tranos::model
