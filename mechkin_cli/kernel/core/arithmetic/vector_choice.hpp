// What chooses among vectors and quaternions by values.
#pragma once

#include "arithmetic/vector.hpp"

namespace {

MECHKIN_INLINE Vec3 select(Mask m, const Vec3& a, const Vec3& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

// The quaternion of a rotation with columns x, y, z, of either sign: the row of 4 q q^T with the largest diagonal
// (Shepperd, Quaternion from rotation matrix, J. Guidance and Control 1, 1978).
MECHKIN_INLINE Quaternion quaternion_of(const Vec3& x, const Vec3& y, const Vec3& z) {
  const Pack one = 1.0, a = y.z - z.y, b = z.x - x.z, c = x.y - y.x;
  const Pack d = x.y + y.x, e = x.z + z.x, f = y.z + z.y;
  const Quaternion rows[4] = {{one + x.x + y.y + z.z, a, b, c},
                              {a, one + x.x - y.y - z.z, d, e},
                              {b, d, one - x.x + y.y - z.z, f},
                              {c, e, f, one - x.x - y.y + z.z}};
  Quaternion q = rows[0];
  Pack best = rows[0].w;
  const Pack diagonal[4] = {rows[0].w, rows[1].x, rows[2].y, rows[3].z};
  for (int k = 1; k < 4; ++k) {
    const Mask larger = diagonal[k] > best;
    best = select(larger, diagonal[k], best);
    q = {select(larger, rows[k].w, q.w), select(larger, rows[k].x, q.x), select(larger, rows[k].y, q.y),
         select(larger, rows[k].z, q.z)};
  }
  return normalised(q);
}

}  // namespace
