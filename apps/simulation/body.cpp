#include "body.h"

#include <cmath>

namespace orchard::simulation {

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 unit(const Vec3& v) {
  const double l = length(v);
  return l > 0 ? (1 / l) * v : Vec3{};
}

Vec3 turned(const Quaternion& q, const Vec3& v) {
  const Vec3 u{q[1], q[2], q[3]};
  const Vec3 t = 2.0 * cross(u, v);
  return v + q[0] * t + cross(u, t);
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion normalized(const Quaternion& q) {
  const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return l > 0 ? Quaternion{q[0] / l, q[1] / l, q[2] / l, q[3] / l} : Quaternion{1, 0, 0, 0};
}

Quaternion about(const Vec3& axis, double angle) {
  const double s = std::sin(angle / 2);
  return {std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]};
}

void integrate(Body& body, double dt, double max_acceleration) {
  Vec3 acceleration = (1 / body.mass) * body.force;
  const double size = length(acceleration);
  if (size > max_acceleration) acceleration = (max_acceleration / size) * acceleration;
  body.velocity = body.velocity + dt * acceleration;
  body.position = body.position + dt * body.velocity;
  body.spin = body.spin + (dt / body.inertia) * body.torque;
  // The quaternion's derivative: no sine, so the same on every machine.
  const Quaternion rate = product({0, body.spin[0], body.spin[1], body.spin[2]}, body.attitude);
  for (std::size_t i = 0; i < 4; ++i) body.attitude[i] += dt / 2 * rate[i];
  body.attitude = normalized(body.attitude);
  body.force = body.torque = {};
}

}  // namespace orchard::simulation
