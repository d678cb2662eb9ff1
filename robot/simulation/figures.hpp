// Upright figures that turn towards the camera: visitors with their clothes, the robot, what stands on the exhibits,
// and the exhibits' number plates.
#pragma once

#include "robot/simulation/canvas.hpp"
#include "robot/simulation/person.hpp"
#include "robot/simulation/scene.hpp"

namespace robot::simulation {

// All of them, far to near, with soft shadows under those who walk.
void paint_figures(Canvas& canvas, const Lens& lens, const Scene& scene, const Snapshot& moment, bool robot);

void paint_person(Canvas& canvas, const Lens& lens, const Person& person);
void paint_robot(Canvas& canvas, const Lens& lens, const Pose& map_from_base);
void paint_ornament(Canvas& canvas, const Lens& lens, const SceneExhibit& exhibit);
void paint_plate(Canvas& canvas, const Lens& lens, const SceneExhibit& exhibit);

}  // namespace robot::simulation
