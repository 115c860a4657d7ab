// A bearing block: a rounded foot, a bore, bolt holes, a lubrication nipple. Everything in it stays exact.
$fa = 6;
$fs = 0.5;

module foot() {
  hull() for (x = [-26, 26], y = [-12, 12]) translate([x, y, 0]) cylinder(r = 6, h = 8);
}

module housing() {
  translate([0, 0, 26]) rotate([90, 0, 0]) cylinder(r = 20, h = 30, center = true);
  translate([-20, -15, 0]) cube([40, 30, 26]);
}

color("steelblue") difference() {
  union() {
    foot();
    housing();
  }
  translate([0, 0, 26]) rotate([90, 0, 0]) cylinder(r = 12, h = 40, center = true);
  for (x = [-26, 26]) translate([x, 0, 0]) {
    translate([0, 0, -1]) cylinder(r = 3, h = 10);
    translate([0, 0, 6]) cylinder(r1 = 3, r2 = 6, h = 3);
  }
}

color("goldenrod") translate([0, 0, 26]) rotate([90, 0, 0])
  rotate_extrude() translate([10, -16]) square([2, 32]);

color("silver") translate([0, 0, 45]) {
  cylinder($fn = 6, r = 4, h = 4);
  translate([0, 0, 4]) cylinder(r1 = 2.5, r2 = 1.5, h = 3);
  translate([0, 0, 8]) sphere(r = 2);
}
