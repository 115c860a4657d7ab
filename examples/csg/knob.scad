// A knob: a turned body with grips cut out of it, and a twisted stem.
$fa = 6;
$fs = 0.5;

color("firebrick") difference() {
  rotate_extrude() {
    square([14, 10]);
    translate([0, 8]) hull() {
      square([14, 2]);
      translate([9, 6]) circle(r = 3);
      square([1, 9]);
    }
  }
  for (a = [0:45:315]) rotate(a) translate([17, 0, -1]) cylinder(r = 5, h = 20);
  translate([0, 0, 17]) linear_extrude(height = 3) offset(r = 0.6) square([1, 7], center = true);
}

color("silver") translate([0, 0, -16]) linear_extrude(height = 16, twist = 180) square(7, center = true);
