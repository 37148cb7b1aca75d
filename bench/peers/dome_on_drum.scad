// SPDX-License-Identifier: GPL-3.0-or-later
// scripts/dome_on_drum.trn for OpenSCAD.
many = 128;
few = 32;
translate([0, 0, 8]) difference() {
  sphere(r = 10, $fn = many);
  sphere(r = 9.5, $fn = many);
  translate([-20, -20, -40]) cube(40);
  cylinder(r = 1.5, h = 30, $fn = few);
}
difference() {
  cylinder(r = 10.5, h = 8, $fn = many);
  translate([0, 0, -1]) cylinder(r = 9.5, h = 10, $fn = many);
  for (turn = [0 : 15 : 345]) rotate(turn) translate([8, 0, 2]) rotate([90, 0, 90])
    linear_extrude(4) union() {
      translate([-0.5, 0]) square([1, 3]);
      translate([0, 3]) circle(r = 0.5, $fn = few);
    }
}
translate([0, 0, 17.5]) difference() {
  cylinder(r = 2, h = 4, $fn = few);
  translate([0, 0, -1]) cylinder(r = 1.5, h = 4, $fn = few);
}
translate([0, 0, 21.5]) cylinder(r1 = 2.2, r2 = 0, h = 2, $fn = few);
