#include "robot/simulation/painter.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "robot/geometry/random.hpp"
#include "tests/robot/simulation/scenes.hpp"

namespace robot::simulation {
namespace {

// A hall of 20 m x 12 m, an exhibit straight ahead of the camera, nobody about.
Museum gallery() {
  Museum museum = testing::hall(20.0, 12.0, 0.05);
  testing::build(museum, 9.0, 5.0, 11.0, 7.0);
  museum.exhibits = {testing::exhibit("press", 6, testing::box(9.0, 5.0, 11.0, 7.0))};
  return museum;
}

CameraView looking_at_the_exhibit() {
  CameraView view = onboard_view({4.0, 6.0, 0.0});
  view.width = 320;
  view.height_px = 180;
  return view;
}

int differing(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const int off =
        std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) + std::abs(a.rgb[i + 2] - b.rgb[i + 2]);
    count += off > 24;
  }
  return count;
}

Color mean(const Image& image, int left, int top, int right, int bottom) {
  Color sum;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const std::size_t i =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
      sum = sum + Color{1.0f * image.rgb[i], 1.0f * image.rgb[i + 1], 1.0f * image.rgb[i + 2]};
    }
  }
  return (1.0f / static_cast<float>((right - left) * (bottom - top))) * sum;
}

TEST(Painter, PictureHasItsSize) {
  const Painter painter(gallery());
  const Image image = painter.render(looking_at_the_exhibit(), {});
  EXPECT_EQ(image.width, 320);
  EXPECT_EQ(image.height, 180);
  EXPECT_EQ(image.rgb.size(), 320u * 180u * 3u);
}

TEST(Painter, SameMomentSamePicture) {
  const Museum museum = gallery();
  Snapshot moment;
  moment.people.resize(1);
  moment.people[0].position = {7.0, 6.5};
  EXPECT_EQ(Painter(museum).render(looking_at_the_exhibit(), moment).rgb,
            Painter(museum).render(looking_at_the_exhibit(), moment).rgb);
}

TEST(Painter, FloorWallAndExhibitDiffer) {
  const Image image = Painter(gallery()).render(looking_at_the_exhibit(), {});
  const Color floor = mean(image, 100, 160, 220, 175);
  const Color wall = mean(image, 20, 40, 60, 60);
  const Color exhibit = mean(image, 130, 96, 145, 106);
  const auto apart = [](Color a, Color b) { return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b); };
  EXPECT_GT(apart(floor, wall), 15.0f);
  EXPECT_GT(apart(floor, exhibit), 80.0f);
  EXPECT_GT(apart(wall, exhibit), 80.0f);
}

TEST(Painter, PeopleStandOutAndGrowAsTheyComeNearer) {
  const Painter painter(gallery());
  const Image nobody = painter.render(looking_at_the_exhibit(), {});
  int before = 0;
  for (const double far : {4.5, 3.0, 1.5}) {
    Snapshot moment;
    moment.people.resize(1);
    moment.people[0].position = {4.0 + far, 6.0};
    const int covered = differing(nobody, painter.render(looking_at_the_exhibit(), moment));
    EXPECT_GT(covered, before + 200) << far;
    before = covered;
  }
}

TEST(Painter, ExhibitsAndWallsHideThoseBehindThem) {
  const Painter painter(gallery());
  const CameraView view = looking_at_the_exhibit();
  const Image nobody = painter.render(view, {});
  Snapshot behind_camera, outside, behind_exhibit, before_exhibit;
  for (Snapshot* moment : {&behind_camera, &outside, &behind_exhibit, &before_exhibit}) moment->people.resize(1);
  behind_camera.people[0].position = {3.0, 6.0};
  outside.people[0].position = {25.0, 6.0};
  behind_exhibit.people[0].position = {12.0, 6.0};
  before_exhibit.people[0].position = {8.0, 6.0};
  EXPECT_EQ(differing(nobody, painter.render(view, behind_camera)), 0);
  EXPECT_EQ(differing(nobody, painter.render(view, outside)), 0);
  // Legs are hidden, the head looks over.
  EXPECT_LT(differing(nobody, painter.render(view, behind_exhibit)),
            differing(nobody, painter.render(view, before_exhibit)) / 2);
}

TEST(Painter, WallCameraSeesTheRobotAndTheRobotNotItself) {
  const Painter painter(gallery());
  WallCamera camera;
  camera.pose = {2.0, 1.0, 0.9};
  const CameraView wall = wall_view(camera);
  Snapshot here, there;
  here.robot = {4.5, 4.5, -2.0};
  there.robot = {30.0, 4.0, 0.0};
  EXPECT_GT(differing(painter.render(wall, here), painter.render(wall, there)), 300);
  const CameraView own = onboard_view({6.0, 3.0, 0.0});
  EXPECT_EQ(differing(painter.render(own, here), painter.render(own, there)), 0);
}

TEST(Painter, AnyViewGivesAPicture) {
  const Painter painter(gallery());
  Random random(3);
  Snapshot moment;
  moment.people.resize(20);
  for (auto& person : moment.people) person.position = {random.uniform(0.0, 20.0), random.uniform(0.0, 12.0)};
  for (int i = 0; i < 200; ++i) {
    CameraView view;
    view.width = 64;
    view.height_px = 48;
    view.pose = {random.uniform(-5.0, 25.0), random.uniform(-5.0, 17.0), random.uniform(-pi, pi)};
    view.height = random.uniform(0.2, 4.5);
    view.tilt = random.uniform(-1.2, 0.8);
    moment.robot = {random.uniform(0.0, 20.0), random.uniform(0.0, 12.0), random.uniform(-pi, pi)};
    EXPECT_EQ(painter.render(view, moment).rgb.size(), 64u * 48u * 3u);
  }
}

}  // namespace
}  // namespace robot::simulation
