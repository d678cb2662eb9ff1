#include "robot/localization/pose_bins.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include <set>
#include <tuple>

#include "robot/geometry/random.hpp"

namespace robot {
namespace {

TEST(PoseBins, SamePlaceSameNumber) {
  PoseBins bins(0.5, radians(10));
  EXPECT_EQ(bins.add({0.1, 0.1, 0.01}), 0);
  EXPECT_EQ(bins.add({0.4, 0.1, 0.01}), 0);
  EXPECT_EQ(bins.add({0.6, 0.1, 0.01}), 1);
  EXPECT_EQ(bins.add({0.1, 0.1, 0.3}), 2);
  EXPECT_EQ(bins.add({0.1, 0.1, 0.01 + 2 * pi}), 0);
  EXPECT_EQ(bins.size(), 3);
}

TEST(PoseBins, HeadingWrapsRoundWhenGrouping) {
  PoseBins bins(0.5, radians(10));
  bins.add({0.1, 0.1, pi - 0.01});
  bins.add({0.1, 0.1, -pi + 0.01});
  bins.add({0.1, 0.1, 0.0});
  EXPECT_THAT(bins.groups(), ::testing::ElementsAre(0, 0, 1));
}

TEST(PoseBins, GroupsHangTogetherOverCornersAndOrderDoesNotMatter) {
  PoseBins bins(1.0, radians(10));
  bins.add({0.5, 0.5, 0.0});
  bins.add({2.5, 2.5, 0.0});
  bins.add({9.5, 9.5, 0.0});
  bins.add({1.5, 1.5, 0.0});  // joins the first two
  EXPECT_THAT(bins.groups(), ::testing::ElementsAre(0, 0, 1, 0));
}

TEST(PoseBins, CountsLikeASet) {
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double reach = *rc::gen::element(1.0, 10.0, 1000.0);
    PoseBins bins(0.5, radians(10));
    std::set<std::tuple<long, long, long>> boxes;
    for (int i = 0; i < 3000; ++i) {
      const Pose p{random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-pi, pi)};
      bins.add(p);
      boxes.insert({static_cast<long>(std::floor(p.x / 0.5)), static_cast<long>(std::floor(p.y / 0.5)),
                    static_cast<long>(std::floor((p.theta + pi) / (2 * pi) * 36))});
    }
    RC_ASSERT(static_cast<std::size_t>(bins.size()) == boxes.size());
  }));
}

}  // namespace
}  // namespace robot
