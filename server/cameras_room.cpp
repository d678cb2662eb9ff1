#include "server/cameras_room.hpp"

#include <utility>

#include "server/stream/jpeg.hpp"

namespace server {
namespace {

constexpr auto frame_period = std::chrono::milliseconds(100);
constexpr int jpeg_quality = 72;

robot::simulation::CameraView view_of(std::size_t camera, const std::vector<robot::WallCamera>& walls,
                                      const robot::simulation::Snapshot& moment) {
  return camera == 0 ? robot::simulation::onboard_view(moment.robot) : robot::simulation::wall_view(walls[camera - 1]);
}

}  // namespace

std::vector<CameraInfo> CamerasRoom::infos(const robot::Museum& museum) {
  const robot::simulation::CameraView size;
  std::vector<CameraInfo> infos = {{.id = "onboard",
                                    .title = {{"en", "Robot’s eyes"}, {"de", "Augen des Roboters"}},
                                    .kind = CameraKind::onboard,
                                    .width = size.width,
                                    .height = size.height_px}};
  for (const robot::WallCamera& camera : museum.cameras) {
    infos.push_back({.id = camera.id,
                     .title = camera.title,
                     .kind = CameraKind::wall,
                     .width = size.width,
                     .height = size.height_px});
  }
  return infos;
}

CamerasRoom::CamerasRoom(devices::SimulatedHardware& hardware, Web& web, const robot::Museum& museum,
                         net::io_context& web_io, net::thread_pool& pool)
    : hardware_(hardware),
      web_(web),
      infos_(infos(museum)),
      walls_(museum.cameras),
      painter_(std::make_shared<robot::simulation::Painter>(museum)),
      web_io_(web_io),
      pool_(pool),
      timer_(web_io),
      busy_(infos_.size(), false) {}

void CamerasRoom::tick() {
  for (std::size_t camera = 0; camera < infos_.size(); ++camera) {
    if (!busy_[camera] && web_.camera_wanted(infos_[camera].id)) picture(camera);
  }
  timer_.expires_after(frame_period);
  timer_.async_wait([this](error_code error) {
    if (!error) tick();
  });
}

// World's thread: a snapshot; pool: paint and encode; web thread: hand out. A slow pool skips frames, it never queues.
void CamerasRoom::picture(std::size_t camera) {
  busy_[camera] = true;
  hardware_.with_world([this, camera](robot::simulation::World& world) {
    net::post(pool_, [this, camera, moment = world.snapshot(), painter = painter_] {
      const auto image = painter->render(view_of(camera, walls_, moment), moment);
      auto jpeg = std::make_shared<const std::string>(encode_jpeg(image.rgb, image.width, image.height, jpeg_quality));
      net::post(web_io_, [this, camera, time = moment.time, jpeg = std::move(jpeg)]() mutable {
        busy_[camera] = false;
        web_.frame(infos_[camera].id, std::move(jpeg), time);
      });
    });
  });
}

}  // namespace server
