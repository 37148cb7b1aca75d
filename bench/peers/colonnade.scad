// SPDX-License-Identifier: GPL-3.0-or-later
// scripts/colonnade.trn for OpenSCAD; `-D count=1` builds one of the columns.
count = 200;
places = concat([for (x = [0 : 2 : 138], y = [0, 62]) [x, y, 0]],
                [for (y = [2 : 2 : 60], x = [0, 138]) [x, y, 0]]);
module column() {
  difference() {
    rotate_extrude($fn = 64)
      polygon([[0, 0], [0.7, 0], [0.7, 0.2], [0.6, 0.3], [0.5, 0.4], [0.48, 2.5], [0.42, 5],
               [0.5, 5.2], [0.65, 5.5], [0.65, 5.7], [0, 5.7]]);
    for (turn = [0 : 15 : 345]) rotate(turn) translate([0.51, 0, 0.6])
      cylinder(r = 0.045, h = 4.2, $fn = 12);
  }
}
for (i = [0 : count - 1]) translate(places[i]) column();
