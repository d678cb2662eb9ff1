// gmock matchers for poses and points: EXPECT_THAT(estimate, PoseNear(truth, 0.05));
#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <ostream>

#include "robot/geometry/pose.hpp"

namespace robot {

// Found by gtest through argument lookup, so that failures show numbers and not bytes.
inline void PrintTo(const Point& p, std::ostream* out) { *out << "(" << p.x << " m, " << p.y << " m)"; }
inline void PrintTo(const Pose& p, std::ostream* out) {
  *out << "(" << p.x << " m, " << p.y << " m, " << degrees(p.theta) << " deg)";
}
inline void PrintTo(const Twist& t, std::ostream* out) {
  *out << "(" << t.linear << " m/s, " << t.angular << " rad/s)";
}

namespace testing {

// Within `metres` of the expected point.
MATCHER_P2(PointNear, expected, metres,
           "within " + ::testing::PrintToString(metres) + " m of " + ::testing::PrintToString(expected)) {
  const double off = distance(arg, expected);
  *result_listener << "which is " << off << " m off";
  return off <= metres;
}

// Within `metres` of the expected position and `radians` of the expected heading (across the wrap).
MATCHER_P3(PoseNear, expected, metres, radians,
           "within " + ::testing::PrintToString(metres) + " m and " + ::testing::PrintToString(radians) + " rad of " +
               ::testing::PrintToString(expected)) {
  const double off = distance(arg.position(), expected.position());
  const double turned = std::abs(wrap_angle(arg.theta - expected.theta));
  *result_listener << "which is " << off << " m and " << turned << " rad off";
  return off <= metres && turned <= radians;
}

// The same number for metres and radians.
template <typename P>
auto PoseNear(const P& expected, double tolerance) {
  return PoseNear(expected, tolerance, tolerance);
}

}  // namespace testing
}  // namespace robot
