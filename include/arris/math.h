// math.h — vectors and affine transforms
// What       plain value types; float for storage, double for decisions
// Limits     no normalisation of zero vectors: normalize() of one returns NaN
// Legend     column vectors: world_from_object * p
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace arris {

inline constexpr double kPi = std::numbers::pi;

template <class T>
struct Vec2 {
  T x{}, y{};
  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3() = default;
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit Vec3(T all) : x(all), y(all), z(all) {}
  template <class U>
  constexpr explicit Vec3(const Vec3<U>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}

  constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator/(Vec3 a, Vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3 operator-() const { return {-x, -y, -z}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  constexpr Vec3& operator*=(Vec3 b) { return *this = *this * b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
// Linear, scene-referred, Rec. 709 primaries.
using Rgb = Vec3f;
// Vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_squared(Vec3<T> a) {
  return dot(a, a);
}
template <class T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
template <class T>
Vec3<T> normalize(Vec3<T> a) {
  return a * (T(1) / length(a));
}
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
template <class T>
constexpr T max_component(Vec3<T> a) {
  return a.x > a.y ? (a.x > a.z ? a.x : a.z) : (a.y > a.z ? a.y : a.z);
}
template <class T>
bool is_finite(Vec3<T> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

constexpr double radians(double deg) {
  return deg * (kPi / 180.0);
}
constexpr double degrees(double rad) {
  return rad * (180.0 / kPi);
}

// Three columns; maps column vectors.
struct Mat3d {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  friend constexpr bool operator==(const Mat3d&, const Mat3d&) = default;
  friend constexpr Vec3d operator*(const Mat3d& m, Vec3d v) {
    return m.x * v.x + m.y * v.y + m.z * v.z;
  }
  friend constexpr Mat3d operator*(const Mat3d& a, const Mat3d& b) {
    return {a * b.x, a * b.y, a * b.z};
  }
};

constexpr double determinant(const Mat3d& m) {
  return dot(m.x, cross(m.y, m.z));
}
constexpr Mat3d transpose(const Mat3d& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
// Precondition: determinant(m) != 0.
constexpr Mat3d inverse(const Mat3d& m) {
  const double s = 1.0 / determinant(m);
  return transpose({cross(m.y, m.z) * s, cross(m.z, m.x) * s, cross(m.x, m.y) * s});
}

struct Affine3d {
  Mat3d linear;
  Vec3d translation;

  friend constexpr bool operator==(const Affine3d&, const Affine3d&) = default;
  friend constexpr Affine3d operator*(const Affine3d& a, const Affine3d& b) {
    return {a.linear * b.linear, a.linear * b.translation + a.translation};
  }
};

constexpr Vec3d transform_point(const Affine3d& m, Vec3d p) {
  return m.linear * p + m.translation;
}
constexpr Vec3d transform_vector(const Affine3d& m, Vec3d v) {
  return m.linear * v;
}
// Normals go with the inverse transpose; the result is not unit.
constexpr Vec3d transform_normal(const Affine3d& m, Vec3d n) {
  return transpose(inverse(m.linear)) * n;
}
constexpr Affine3d inverse(const Affine3d& m) {
  const Mat3d linear = inverse(m.linear);
  return {linear, -(linear * m.translation)};
}

}  // namespace arris
