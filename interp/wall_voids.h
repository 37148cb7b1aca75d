// SPDX-License-Identifier: GPL-3.0-or-later
// Which walls are cut by the elements that stand on their faces: a part named `void` of an element
// placed `on=` a wall's face is taken out of the wall, and goes where wall and element go.
#pragma once

#include <map>
#include <vector>

#include "model/edit.h"

namespace tranos::interp {

class WallVoids {
 public:
  // An element about to get the id `guest` stands on the wall: the edit cuts the wall by its voids,
  // if it has any. False if they all lie beside the wall, where they would cut nothing.
  bool Place(const model::Model& model, model::ElementId wall, model::ElementId guest,
             const model::Element& element, model::Edit* edit);
  // Adds what follows from an edit: elements that stand on a wall that is moved go with it, and a
  // wall is cut anew where one of them is moved or deleted by itself.
  void Follow(const model::Model& model, model::Edit* edit) const;

 private:
  struct Wall {
    model::SolidPtr uncut;  // in the frame of its prototype
    std::vector<model::ElementId> guests;
  };
  void Recut(const model::Model& model, model::ElementId id, const Wall& wall,
             const std::map<model::ElementId, model::ElementPtr>& changed, model::Edit* edit) const;

  std::map<model::ElementId, Wall> walls_;
};

}  // namespace tranos::interp
