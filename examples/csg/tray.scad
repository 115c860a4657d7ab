// A tray with rounded edges inside and out: minkowski() with a sphere is a rounded solid, not a mesh.
difference() {
  minkowski() {
    translate([3, 3, 3]) cube([74, 44, 14]);
    sphere(r = 3, $fn = 48);
  }
  minkowski() {
    translate([6, 6, 6]) cube([68, 38, 20]);
    sphere(r = 3, $fn = 48);
  }
  for (x = [16:8:64]) translate([x, -1, 12]) rotate([-90, 0, 0]) cylinder(d = 4, h = 10, $fn = 64);
}
