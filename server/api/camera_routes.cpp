// Pictures: the newest one, and a stream of them that any <img> shows.
#include <boost/beast/core/tcp_stream.hpp>

#include "protocols/web/encode.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;

constexpr auto patience = std::chrono::seconds(3);  // for a picture when none is fresh
constexpr auto freshness = std::chrono::seconds(1);

Reply unknown_camera() {
  return problem_reply({404, "unknown_camera", "There is no such camera; GET cameras lists them.", ""});
}

Reply no_picture() { return Web::Parts::unavailable("no_picture", "The camera gives no picture at the moment."); }

net::awaitable<Picture> fresh_picture(Web::Parts& web, std::size_t camera) {
  web.cameras.glance(camera);
  const Picture newest = web.cameras.newest(camera);
  if (newest.jpeg && Clock::now() - newest.came < freshness) co_return newest;
  co_return co_await web.cameras.next(camera, newest.number, patience);
}

// The newest picture as soon as the line takes it; older ones are skipped. Ends when the viewer does not take one for
// 10 s.
net::awaitable<void> stream(Web::Parts& web, std::size_t camera, tcp::socket socket) {
  web.cameras.look(camera);
  const std::shared_ptr<void> leave(nullptr, [&web, camera](void*) { web.cameras.look_away(camera); });
  error_code error;
  socket.set_option(net::socket_base::send_buffer_size(128 * 1024), error);
  boost::beast::tcp_stream line(std::move(socket));
  std::uint64_t seen = 0;
  while (!web.stopping) {
    const Picture picture = co_await web.cameras.next(camera, seen, std::chrono::seconds(10));
    if (!picture.part) co_return;
    seen = picture.number;
    line.expires_after(std::chrono::seconds(10));
    co_await net::async_write(line, net::buffer(*picture.part), quietly(error));
    if (error) co_return;
  }
}

}  // namespace

void add_camera_routes(Router& router, Web::Parts& web) {
  const std::string cameras = "/api/v1/cameras";
  router.add("GET", cameras, at_once([&web](Call& call) {
               Json list = Json::array();
               for (const CameraInfo& camera : web.cameras.infos()) {
                 list.push_back({{"id", camera.id},
                                 {"title", protocols::web::in_language(camera.title, web.language(call))},
                                 {"titles", protocols::web::encode(camera.title)},
                                 {"kind", camera.kind == CameraKind::onboard ? "onboard" : "wall"},
                                 {"width", camera.width},
                                 {"height", camera.height}});
               }
               return json_reply(list);
             }));
  router.add(
      "GET", cameras + "/{id}/frame.jpg",
      [&web](Call& call) -> net::awaitable<Reply> {
        const std::size_t camera = web.cameras.find(call.parameters[0]);
        if (camera == web.cameras.infos().size()) co_return unknown_camera();
        const Picture picture = co_await fresh_picture(web, camera);
        if (!picture.jpeg) co_return no_picture();
        Reply reply;
        reply.content_type = "image/jpeg";
        reply.body = picture.jpeg;
        co_return reply.with("Cache-Control", "no-store");
      },
      "image/jpeg");
  router.add(
      "GET", cameras + "/{id}/stream.mjpg",
      [&web](Call& call) -> net::awaitable<Reply> {
        const std::size_t camera = web.cameras.find(call.parameters[0]);
        if (camera == web.cameras.infos().size()) co_return unknown_camera();
        const Picture picture = co_await fresh_picture(web, camera);
        if (!picture.jpeg) co_return no_picture();
        Reply reply;
        reply.content_type = std::string("multipart/x-mixed-replace; boundary=") + multipart_boundary;
        reply.with("Cache-Control", "no-store").with("X-Accel-Buffering", "no");
        reply.takeover = [&web, camera](tcp::socket socket, const std::string&) {
          return stream(web, camera, std::move(socket));
        };
        co_return reply;
      },
      "multipart/x-mixed-replace");
}

}  // namespace server
