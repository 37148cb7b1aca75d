// SPDX-License-Identifier: GPL-3.0-or-later
// scripts/parish_church.trn for OpenSCAD.
difference() {
  union() {
    cube([60, 13, 8]);
    for (x = [0 : 7 : 56], y = [-1, 12]) translate([x, y, 0]) cube([0.7, 2, 7]);
    translate([-8, 2.5, 0]) cube([9, 8, 20]);
  }
  for (i = [0 : 29], y = [-0.5, 11.5]) translate([1.2 + 1.9 * i, y, 2]) cube([0.8, 2, 3]);
}
translate([0, 0, 8]) rotate([90, 0, 90])
  linear_extrude(60) polygon([[-0.5, 0], [13.5, 0], [6.5, 6]]);
