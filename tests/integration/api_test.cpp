// The real program over HTTP: the documents against its answers, a request's life, what survives kill -9.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>

#include "protocols/files/map_server_file.hpp"
#include "tests/support/http_client.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/server_process.hpp"
#include "tests/support/web_socket_client.hpp"

using testing_support::HttpClient;
using testing_support::Json;
using testing_support::RawLine;
using testing_support::Response;
using testing_support::SchemaChecker;
using testing_support::ServerProcess;
using testing_support::TemporaryFolder;
using testing_support::WebSocketClient;

namespace {

const std::string api = "/api/v1";

// Asks until the answer pleases; fails after `patience`.
template <typename Pleases>
Json wait_until(HttpClient& client, const std::string& path, Pleases pleases, std::chrono::seconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  Json last;
  while (std::chrono::steady_clock::now() < deadline) {
    last = client.get(path).json();
    if (pleases(last)) return last;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  ADD_FAILURE() << path << " did not become as expected: " << last.dump();
  return last;
}

void wait_until_ready(HttpClient& client) {
  wait_until(
      client, "/readyz", [](const Json& answer) { return answer["ready"] == true; }, std::chrono::seconds(60));
}

// Where the robot can stand: half a metre in front of where it stands now, or behind.
Json near_point(HttpClient& client) {
  const Json pose = client.get(api + "/status").json()["pose"];
  for (const double way : {1.0, -1.0, 0.7, -0.7}) {
    const double theta = pose["theta"].get<double>();
    const Json point = {{"x", pose["x"].get<double>() + way * std::cos(theta)},
                        {"y", pose["y"].get<double>() + way * std::sin(theta)}};
    const Response answer = client.post(api + "/queue", point);
    if (answer.status == 201) return answer.json();
  }
  ADD_FAILURE() << "no way out of home";
  return {};
}

// A body for an operation: its example, or made of what there is.
std::string body_for(const Json& operation, const Json& tours) {
  if (!operation.contains("requestBody")) return "";
  const Json& content = operation["requestBody"]["content"]["application/json"];
  if (content.contains("examples")) return content["examples"].begin().value()["value"].dump();
  if (content["schema"].value("x-sample", "") == "tour") return Json{{"tour", tours[0]["id"]}}.dump();
  throw std::runtime_error("no example of a body");
}

TEST(OpenApi, EveryOperationAnswersAsTheDocumentSays) {
  const TemporaryFolder folder;
  ServerProcess server(folder, {"--visitors=3"});
  HttpClient client(server.port());
  wait_until_ready(client);
  const Json document = client.get(api + "/openapi.json").json();
  const SchemaChecker checker(document);
  const Json tours = client.get(api + "/tours").json();
  const std::map<std::string, std::string> samples{{"exhibit", client.get(api + "/exhibits").json()[0]["id"]},
                                                   {"camera", client.get(api + "/cameras").json()[0]["id"]},
                                                   {"request", near_point(client)["id"].dump()}};
  int operations = 0;
  for (const auto& [path, item] : document["paths"].items()) {
    for (const auto& [method, operation] : item.items()) {
      if (method == "parameters" || operation["operationId"] == "streamPictures") continue;
      std::string target = api + path;
      for (const Json& list : {item.value("parameters", Json::array()), operation.value("parameters", Json::array())}) {
        for (const Json& entry : list) {
          const Json& parameter = checker.resolve(entry);
          if (parameter["in"] != "path") continue;
          const std::string mark = "{" + parameter["name"].get<std::string>() + "}";
          const auto& sample =
              samples.at(parameter.contains("x-sample") ? parameter["x-sample"] : parameter["schema"]["x-sample"]);
          target.replace(target.find(mark), mark.size(), sample);
        }
      }
      std::string verb = method;
      for (char& c : verb) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      const Response answer = client.request(verb, target, body_for(operation, tours));
      const std::string status = std::to_string(answer.status),
                        what = verb + " " + target + " -> " + status + " " + answer.body.substr(0, 300);
      ++operations;
      ASSERT_TRUE(operation["responses"].contains(status)) << what;
      const Json& content = checker.resolve(operation["responses"][status])["content"];
      const std::string type = answer.header("content-type");
      ASSERT_TRUE(content.contains(type)) << what << " as " << type;
      if (!content[type].contains("schema")) continue;
      for (const auto& error : checker.check(answer.json(), content[type]["schema"]))
        ADD_FAILURE() << what << "\n" << error;
    }
  }
  EXPECT_GT(operations, 20);
}

TEST(AsyncApi, EveryMessageIsAsTheDocumentSays) {
  const TemporaryFolder folder;
  ServerProcess server(folder, {"--visitors=10"});
  HttpClient client(server.port());
  wait_until_ready(client);
  const Json document = client.get(api + "/asyncapi.json").json();
  const SchemaChecker checker(document);
  WebSocketClient viewer(server.port(), client.cookie());
  viewer.send({{"type", "subscribe"},
               {"topics",
                {"pose", "status", "path", "people", "queue", "viewers", "health", "belief", "velocity_space", "scan",
                 "speech", "note", "visit", "request"}}});
  viewer.send({{"type", "ping"}, {"id", 1}});
  near_point(client);
  std::set<std::string> seen;
  const std::set<std::string> wanted{"hello",  "pose",   "status",         "path",    "people", "queue", "viewers",
                                     "health", "belief", "velocity_space", "request", "pong",   "scan"};
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::includes(seen.begin(), seen.end(), wanted.begin(), wanted.end()) &&
         std::chrono::steady_clock::now() < deadline) {
    const auto message = viewer.read();
    if (!message.text) {
      ASSERT_EQ(message.payload[0], 1);
      const auto count = static_cast<unsigned char>(message.payload[2]) | static_cast<unsigned char>(message.payload[3])
                                                                              << 8;
      ASSERT_EQ(message.payload.size(), 32u + 5u * static_cast<unsigned>(count));
      seen.insert("scan");
      continue;
    }
    const Json json = Json::parse(message.payload);
    const std::string type = json["type"];
    ASSERT_TRUE(document["components"]["messages"].contains(type)) << message.payload;
    for (const auto& error : checker.check(json, document["components"]["messages"][type]["payload"])) {
      ADD_FAILURE() << message.payload.substr(0, 300) << "\n" << error;
    }
    seen.insert(type);
  }
  for (const auto& type : wanted) EXPECT_TRUE(seen.contains(type)) << "no " << type;
}

TEST(Requests, AreFulfilledByARobotThatDrivesThere) {
  const TemporaryFolder folder;
  ServerProcess server(folder, {"--visitors=0"});
  HttpClient client(server.port());
  wait_until_ready(client);
  const Json made = near_point(client);
  const std::string path = api + "/queue/" + made["id"].dump();
  const Json done = wait_until(
      client, path, [](const Json& request) { return request["state"] == "fulfilled" || request["state"] == "failed"; },
      std::chrono::seconds(120));
  EXPECT_EQ(done["state"], "fulfilled") << done["reason"];
  const Json statistics = client.get(api + "/statistics").json();
  EXPECT_EQ(statistics["fulfilled"], 1);
  EXPECT_GT(statistics["distance_m"].get<double>(), 0.3);
  EXPECT_EQ(server.stop(), 0);
}

TEST(Requests, ThatCannotBeAreRefusedWithAReason) {
  const TemporaryFolder folder;
  ServerProcess server(folder, {"--visitors=0"});
  HttpClient client(server.port());
  wait_until_ready(client);
  const Json site = client.get(api + "/site").json();
  const auto code = [&](const std::string& body) {
    const Response answer = client.request("POST", api + "/queue", body);
    EXPECT_GE(answer.status, 400) << body;
    EXPECT_LT(answer.status, 500) << body;
    return answer.json()["code"].get<std::string>();
  };
  EXPECT_EQ(code(R"({"x": NaN, "y": 0})"), "bad_json");
  EXPECT_EQ(code(R"({"x": 1e999, "y": 0})"), "bad_json");
  EXPECT_EQ(code(R"({"x": 1e300, "y": -1e300})"), "off_the_map");
  EXPECT_EQ(code(R"({"x": -100, "y": 5})"), "off_the_map");
  EXPECT_EQ(code(R"({"exhibit": "no such thing"})"), "unknown_exhibit");
  EXPECT_EQ(code(Json{{"exhibit", client.get(api + "/exhibits").json()[0]["id"]}, {"viewpoint", 999}}.dump()),
            "unknown_viewpoint");
  for (const Json& hazard : site["hazards"]) {
    double x = 0, y = 0;
    for (const Json& corner : hazard["polygon"]) {
      x += corner[0].get<double>() / static_cast<double>(hazard["polygon"].size());
      y += corner[1].get<double>() / static_cast<double>(hazard["polygon"].size());
    }
    EXPECT_THAT(code(Json{{"x", x}, {"y", y}}.dump()),
                testing::AnyOf("in_hazard", "inside_obstacle", "off_the_map", "unreachable"))
        << hazard["id"];
  }
  const Json exhibit = client.get(api + "/exhibits").json()[0];
  double x = 0, y = 0;
  for (const Json& corner : exhibit["outline"]) {
    x += corner[0].get<double>() / static_cast<double>(exhibit["outline"].size());
    y += corner[1].get<double>() / static_cast<double>(exhibit["outline"].size());
  }
  EXPECT_THAT(code(Json{{"x", x}, {"y", y}}.dump()), testing::AnyOf("inside_obstacle", "in_hazard", "unreachable"))
      << "inside an exhibit";
  const robot::OccupancyGrid map = files::read_map_server("static/sites/rhine-hall/map.yaml");
  std::vector<robot::Point> walls;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (robot::is_occupied(map[map.cell_at(i)])) walls.push_back(map.center(map.cell_at(i)));
  }
  for (std::size_t i = 0; i < walls.size(); i += walls.size() / 4) {
    EXPECT_EQ(code(Json{{"x", walls[i].x}, {"y", walls[i].y}}.dump()), "inside_obstacle")
        << "a wall at " << walls[i].x << ", " << walls[i].y;
  }
  EXPECT_EQ(client.get(api + "/queue").json().size(), 0u);
}

TEST(Crash, LosesNoAcceptedRequest) {
  const TemporaryFolder folder;
  std::set<std::uint64_t> accepted;
  for (int round = 0; round < 3; ++round) {
    ServerProcess server(folder, {"--visitors=0"});
    HttpClient client(server.port());
    wait_until_ready(client);
    for (const std::uint64_t id : accepted) {
      EXPECT_EQ(client.get(api + "/queue/" + std::to_string(id)).status, 200) << "request " << id << " was lost\n"
                                                                              << server.log();
    }
    const Json exhibits = client.get(api + "/exhibits").json();
    std::atomic<bool> go_on{true};
    std::thread killer([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(150 + 70 * round));
      server.kill_at_once();
      go_on = false;
    });
    for (std::size_t i = 0; go_on; ++i) {
      try {
        HttpClient visitor(server.port());
        const Response answer = visitor.post(api + "/queue", {{"exhibit", exhibits[i % exhibits.size()]["id"]}},
                                             {{"Idempotency-Key", std::to_string(round) + "-" + std::to_string(i)}});
        if (answer.status == 201) accepted.insert(answer.json()["id"].get<std::uint64_t>());
      } catch (const std::exception&) {
        // cut off in the middle: not accepted
      }
    }
    killer.join();
  }
  EXPECT_FALSE(accepted.empty());
  ServerProcess server(folder, {"--visitors=0"});
  HttpClient client(server.port());
  for (const std::uint64_t id : accepted) EXPECT_EQ(client.get(api + "/queue/" + std::to_string(id)).status, 200) << id;
  EXPECT_THAT(server.log(), testing::Not(testing::HasSubstr("damaged")));
}

TEST(Crash, LeavesTheAnswerUnderItsKey) {
  const TemporaryFolder folder;
  std::string body;
  {
    ServerProcess server(folder, {"--visitors=0"});
    HttpClient client(server.port());
    wait_until_ready(client);
    const std::string exhibit = client.get(api + "/exhibits").json()[1]["id"];
    body = client.post(api + "/queue", {{"exhibit", exhibit}}, {{"Idempotency-Key", "one"}}).body;
    server.kill_at_once();
  }
  ServerProcess server(folder, {"--visitors=0"});
  HttpClient client(server.port());
  wait_until_ready(client);
  const std::string exhibit = client.get(api + "/exhibits").json()[1]["id"];
  const Response again = client.post(api + "/queue", {{"exhibit", exhibit}}, {{"Idempotency-Key", "one"}});
  EXPECT_EQ(again.body, body);
  EXPECT_EQ(again.header("idempotent-replayed"), "true");
  EXPECT_EQ(client.get(api + "/queue").json().size(), 1u);
}

TEST(Crowd, OfBadClientsDoesNotDisturbTheRobot) {
  const TemporaryFolder folder;
  ServerProcess server(folder, {"--visitors=0"});
  HttpClient client(server.port());
  wait_until_ready(client);
  std::vector<std::unique_ptr<RawLine>> lines;
  for (int i = 0; i < 60; ++i) {
    lines.push_back(std::make_unique<RawLine>(server.port()));
    static const std::string kinds[] = {
        "GET /api/v1/status HTTP/1.1\r\nHost:",
        "POST /api/v1/queue HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 60000\r\n\r\n{",
        std::string("\x16\x03\x01\0\0", 5),
        "GET /ws HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: "
        "13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n\xFF\xFF\xFF\xFF"};
    lines.back()->send(kinds[i % 4]);
  }
  const Json made = near_point(client);
  wait_until(
      client, api + "/queue/" + made["id"].dump(), [](const Json& request) { return request["state"] == "fulfilled"; },
      std::chrono::seconds(120));
  for (const auto& line : lines) {
    line->read(std::chrono::milliseconds(20'000));
    EXPECT_TRUE(line->closed()) << "bad clients are let go";
  }
  EXPECT_EQ(client.get("/healthz").status, 200);
}

}  // namespace
