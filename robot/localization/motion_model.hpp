// How the belief follows the wheels: the odometry motion model of Thrun, Burgard and Fox, "Probabilistic Robotics",
// table 5.6, in a form without its singularity at rest and whose noise does not depend on how often odometry is read.
#pragma once

#include "robot/geometry/pose.hpp"
#include "robot/geometry/random.hpp"

namespace robot {

// Standard deviations. What grows with the way is a random walk (with its square root); what grows with the turn or is
// relative stays proportional, as a wheel of the wrong size does.
struct MotionNoise {
  double rotation_from_rotation = 0.12;       // rad a rad turned (alpha1)
  double rotation_from_translation = 0.035;   // rad a square root of a metre (alpha2)
  double translation_from_translation = 0.1;  // m a m (alpha3)
  double translation_from_rotation = 0.02;    // m a rad turned (alpha4)
  double rotation_floor = 0.003;              // rad a step, whatever its length: keeps the belief alive
  double translation_floor = 0.004;           // m a step
  // Wheels that slip, on a rug or against somebody's foot, and encoders that lose their sign say little: a sample that
  // slips takes any part of the step, forwards or backwards, and the noise this many times. It is rare, but when it
  // happens a sample must be there: more of them slip than is probable, and weigh as much less (importance sampling).
  double slip_rate = 0.03;  // a metre of the wheels' way
  double slip_share = 0.1;  // of the samples
  double slip_factor = 4.0;
};

// Where the wheels say the base went between two scans, and how much they did on the way there.
struct MotionStep {
  Pose moved;           // the new base seen from the old one
  double path = 0.0;    // m, length of the way: at least that of `moved`
  double turned = 0.0;  // rad, sum of absolute turns: at least that of `moved`
};

// The noise's spread for one step.
struct MotionSpread {
  double rotation = 0.0;     // rad, half of its variance acts before the translation and half after
  double stretch = 0.0;      // relative, along the way
  double translation = 0.0;  // m, each axis
  double slip_share = 0.0;
  double slip_factor = 1.0;
  double slip_weight = 1.0;  // of a sample that slips ...
  double grip_weight = 1.0;  // ... and of one that does not: their probability over their share
};
MotionSpread spread_of(const MotionStep& step, const MotionNoise& noise);

// One sample of where a base at `from` is after the step, and the factor on its weight. Without noise the pose is
// exactly from * step.moved.
struct MotionSample {
  Pose pose;
  double weight = 1.0;
};
MotionSample sample_motion(const Pose& from, const MotionStep& step, const MotionSpread& spread, Random& random);

}  // namespace robot
