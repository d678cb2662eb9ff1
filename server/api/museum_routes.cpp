// The museum: site, exhibits, tours, map, and the documents that describe the wire.
#include <opencv2/imgcodecs.hpp>

#include "protocols/web/encode.hpp"
#include "server/api/documents.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;

// Row 0 at the top; grey values as map_server's trinary maps have them.
std::string map_png(const robot::OccupancyGrid& map) {
  cv::Mat image(std::max(map.height(), 1), std::max(map.width(), 1), CV_8UC1, cv::Scalar(205));
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const std::int8_t value = map[{x, y}];
      image.at<std::uint8_t>(map.height() - 1 - y, x) = robot::is_occupied(value) ? 0
                                                        : robot::is_free(value)   ? 254
                                                                                  : 205;
    }
  }
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", image, png, {cv::IMWRITE_PNG_COMPRESSION, 9}))
    throw std::runtime_error("cannot encode the map");
  return {png.begin(), png.end()};
}

}  // namespace

void add_museum_routes(Router& router, Web::Parts& web) {
  const std::string api = "/api/v1/";
  router.add("GET", api + "site", at_once([&web](Call& call) {
               return web.document(call, "site",
                                   [&] { return protocols::web::encode_site(web.museum, web.options.footprint); });
             }));
  router.add("GET", api + "exhibits", at_once([&web](Call& call) {
               const std::string language = web.language(call);
               return web.document(call, "exhibits " + language, [&] {
                 Json list = Json::array();
                 for (const auto& exhibit : web.museum.exhibits) {
                   list.push_back(protocols::web::encode_exhibit(exhibit, language));
                 }
                 return list;
               });
             }));
  router.add("GET", api + "exhibits/{id}", at_once([&web](Call& call) {
               const robot::Exhibit* exhibit = robot::find_exhibit(web.museum, call.parameters[0]);
               if (!exhibit) {
                 return problem_reply(
                     {404, "unknown_exhibit", "There is no exhibit of that id; GET exhibits lists them.", ""});
               }
               return json_reply(protocols::web::encode_exhibit(*exhibit, web.language(call)));
             }));
  router.add("GET", api + "tours", at_once([&web](Call& call) {
               const std::string language = web.language(call);
               return web.document(call, "tours " + language, [&] {
                 Json list = Json::array();
                 for (const auto& tour : web.museum.tours) {
                   list.push_back(protocols::web::encode_tour(tour, web.museum, language));
                 }
                 return list;
               });
             }));
  router.add("GET", api + "map", at_once([&web](Call& call) {
               Reply reply = web.document(
                   call, "map", [&] { return protocols::web::encode_map(web.museum.map, "/api/v1/map.png"); });
               return reply.with("Vary", "Accept");
             }));
  const Handler picture = at_once([&web](Call& call) {
    Reply reply = web.document(call, "map.png", "image/png", [&] { return map_png(web.museum.map); });
    return reply.with("Vary", "Accept");
  });
  router.add("GET", api + "map", picture, "image/png");
  router.add("GET", api + "map.png", picture, "image/png");
  router.add("GET", api + "openapi.json", at_once([&web](Call& call) {
               return web.document(call, "openapi", [] { return yaml_to_json(openapi_yaml); });
             }));
  router.add("GET", api + "asyncapi.json", at_once([&web](Call& call) {
               return web.document(call, "asyncapi", [] { return yaml_to_json(asyncapi_yaml); });
             }));
}

}  // namespace server
