// Every REST path with a robot that answers at once.
#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/web_house.hpp"

using testing_support::HttpClient;
using testing_support::Json;
using testing_support::TemporaryFolder;
using testing_support::WebHouse;

namespace {

const std::string api = "/api/v1/";

TEST(Rest, ShowsTheMuseum) {
  WebHouse house;
  HttpClient client(house.port);
  const Json site = client.get(api + "site").json();
  EXPECT_EQ(site["id"], "test-hall");
  EXPECT_EQ(site["width"], 200);
  EXPECT_EQ(site["hazards"][0]["kind"], "low_obstacle");
  EXPECT_EQ(site["languages"], Json({"de", "en"}));
  const Json exhibits = client.get(api + "exhibits?lang=de").json();
  ASSERT_EQ(exhibits.size(), 2u);
  EXPECT_EQ(exhibits[0]["title"], "Das beam-engine");
  EXPECT_EQ(exhibits[0]["x"], 2.5);
  EXPECT_EQ(client.get(api + "exhibits").json()[0]["title"], "The beam-engine");
  EXPECT_EQ(client.get(api + "exhibits/orrery").json()["number"], 2);
  EXPECT_EQ(client.get(api + "exhibits/nothing").status, 404);
  EXPECT_EQ(client.get(api + "tours").json()[0]["exhibits"], Json({"beam-engine", "orrery"}));
  const Json map = client.get(api + "map").json();
  EXPECT_EQ(map["origin"]["x"], -1.0);
  const auto png = client.get(map["url"]);
  EXPECT_EQ(png.header("content-type"), "image/png");
  EXPECT_EQ(png.body.substr(1, 3), "PNG");
  EXPECT_EQ(client.get(map["url"], {{"If-None-Match", png.header("etag")}}).status, 304);
  EXPECT_EQ(client.get(api + "map", {{"Accept", "image/png"}}).body, png.body);
  EXPECT_EQ(client.get(api + "map", {{"Accept", "text/html, image/*, */*;q=0.8"}}).body, png.body) << "an <img> tag";
  EXPECT_EQ(client.get(api + "map", {{"Accept", "*/*"}}).json(), map);
  EXPECT_EQ(client.get(api + "map", {{"Accept", "text/html"}}).status, 406);
}

TEST(Rest, TakesARequestThroughItsLife) {
  WebHouse house;
  HttpClient client(house.port), stranger(house.port, "docent.example");
  const auto made = client.post(api + "queue", {{"exhibit", "orrery"}, {"name", " Mirela "}});
  ASSERT_EQ(made.status, 201) << made.body;
  EXPECT_EQ(made.json()["state"], "pending");
  EXPECT_EQ(made.json()["name"], "Mirela");
  EXPECT_EQ(made.json()["yours"], true);
  EXPECT_EQ(client.get(made.header("location")).json()["id"], made.json()["id"]);
  EXPECT_EQ(client.get(api + "queue").json().size(), 1u);
  EXPECT_EQ(stranger.get(api + "queue").json()[0]["yours"], false);
  EXPECT_EQ(stranger.request("DELETE", made.header("location")).json()["code"], "not_yours");
  EXPECT_EQ(client.request("DELETE", made.header("location")).json()["state"], "cancelled");
  EXPECT_EQ(client.request("DELETE", made.header("location")).status, 409);
  EXPECT_EQ(client.get(api + "session").json()["name"], "Mirela");
  EXPECT_EQ(client.get(api + "queue/99").status, 404);
  EXPECT_EQ(client.get(api + "queue/-1").status, 404);
  EXPECT_EQ(client.get(api + "queue/99999999999999999999").status, 404);
}

TEST(Rest, RefusesGoalsThatCannotBe) {
  WebHouse house;
  HttpClient client(house.port);
  const auto code = [&](const std::string& body) {
    const auto answer = client.request("POST", api + "queue", body);
    EXPECT_EQ(answer.header("content-type"), "application/problem+json");
    return std::to_string(answer.status) + " " + answer.json()["code"].get<std::string>();
  };
  EXPECT_EQ(code(R"({"x": 3.0, "y": -0.98})"), "422 inside_obstacle");
  EXPECT_EQ(code(R"({"x": 3.0, "y": 1e300})"), "422 off_the_map");
  EXPECT_EQ(code(R"({"x": 1e999, "y": 1})"), "400 bad_json");
  EXPECT_EQ(code(R"({"x": NaN, "y": 1})"), "400 bad_json");
  EXPECT_EQ(code(R"({"x": null, "y": 1})"), "422 missing_field");
  EXPECT_EQ(code(R"({"x": "1", "y": 1})"), "422 wrong_type");
  EXPECT_EQ(code(R"({"exhibit": "none"})"), "422 unknown_exhibit");
  EXPECT_EQ(code(R"({"exhibit": "orrery", "viewpoint": 7})"), "422 unknown_viewpoint");
  EXPECT_EQ(code(R"({"exhibit": "orrery", "viewpoint": -1})"), "422 bad_number");
  EXPECT_EQ(code(R"({"exhibit": "orrery", "x": 1, "y": 1})"), "422 ambiguous_target");
  EXPECT_EQ(code(R"({"exhibit": "orrery", "nmae": "x"})"), "422 unknown_field");
  EXPECT_EQ(code(R"({"exhibit": "orrery", "name": "a\u0007b"})"), "422 bad_name");
  EXPECT_EQ(code("[1]"), "422 not_an_object");
  EXPECT_EQ(code("{"), "400 bad_json");
}

TEST(Rest, AnswersASilentRobotWith503AndUndoesWhatComesLate) {
  server::WebOptions options;
  options.limits.answer = std::chrono::milliseconds(100);
  WebHouse house(options);
  HttpClient client(house.port);
  house.on_web([&] { house.robot.silent = true; });
  const auto answer = client.post(api + "queue", {{"exhibit", "orrery"}});
  EXPECT_EQ(answer.status, 503);
  EXPECT_FALSE(answer.header("retry-after").empty());
  robot::Ticket ticket = 0;
  house.on_web([&] {
    ticket = std::get<robot::RequestVisit>(house.robot.heard.back()).ticket;
    house.robot.silent = false;
  });
  house.say({robot::Answer{ticket, robot::Refusal::none, {7}}});
  house.on_web([] {});
  house.on_web([&] { EXPECT_EQ(std::get<robot::CancelRequest>(house.robot.heard.back()).id, 7u); });
}

TEST(Rest, GivesTheSameAnswerForTheSameKey) {
  const TemporaryFolder folder;
  server::WebOptions options;
  options.database = (folder.path() / "docent.db").string();
  std::string body, location;
  {
    WebHouse house(options);
    HttpClient client(house.port);
    const auto first = client.post(api + "queue", {{"exhibit", "orrery"}}, {{"Idempotency-Key", "k1"}});
    ASSERT_EQ(first.status, 201);
    body = first.body, location = first.header("location");
    EXPECT_EQ(client.post(api + "queue", {{"exhibit", "orrery"}}, {{"Idempotency-Key", "k1"}}).body, body);
    EXPECT_EQ(client.post(api + "queue", {{"exhibit", "beam-engine"}}, {{"Idempotency-Key", "k1"}}).status, 422);
    EXPECT_EQ(client.get(api + "queue").json().size(), 1u);
  }
  WebHouse house(options);  // and after a restart
  const auto remembered = house.web().remember();
  ASSERT_EQ(remembered.open.size(), 1u);
  EXPECT_EQ(remembered.next_id, remembered.open[0].id + 1);
  EXPECT_EQ(std::get<robot::ExhibitTarget>(remembered.open[0].target).exhibit, "orrery");
  HttpClient client(house.port);
  const auto again = client.post(api + "queue", {{"exhibit", "orrery"}}, {{"Idempotency-Key", "k1"}});
  EXPECT_EQ(again.status, 201);
  EXPECT_EQ(again.body, body);
  EXPECT_EQ(again.header("location"), location);
  EXPECT_EQ(client.get(location).json()["state"], "pending");
}

TEST(Rest, RefusesWhatItCannotStoreAndRecovers) {
  const TemporaryFolder folder;
  server::WebOptions options;
  options.database = (folder.path() / "docent.db").string();
  WebHouse house(options);
  HttpClient client(house.port);
  {
    SQLite::Database other(options.database, SQLite::OPEN_READWRITE);
    other.exec("BEGIN IMMEDIATE");  // nobody else can write
    const auto refused = client.post(api + "queue", {{"exhibit", "orrery"}});
    EXPECT_EQ(refused.status, 503);
    EXPECT_EQ(refused.json()["code"], "storage");
    house.on_web([&] { EXPECT_EQ(house.robot.requests.at(1).state, robot::RequestState::cancelled); });
    EXPECT_EQ(client.request("POST", api + "stop").status, 200) << "stopping needs no disk";
    other.exec("ROLLBACK");
  }
  int status = 0;
  for (int i = 0; i < 50 && status != 201; ++i) {
    status = client.post(api + "queue", {{"exhibit", "orrery"}}).status;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  EXPECT_EQ(status, 201) << "without a restart";
  EXPECT_EQ(client.get(api + "health").json()["database"], true);
}

TEST(Rest, KnowsStaff) {
  server::WebOptions options;
  options.staff_password = "open sesame";
  WebHouse house(options);
  HttpClient client(house.port);
  EXPECT_EQ(client.get(api + "session").json()["staff"], false);
  EXPECT_EQ(client.post(api + "stop", Json()).status, 403);
  EXPECT_EQ(client.post(api + "session", {{"password", "wrong"}}).status, 401);
  const std::string before = client.cookie();
  EXPECT_EQ(client.post(api + "session", {{"password", "open sesame"}}).json()["staff"], true);
  EXPECT_NE(client.cookie(), before);
  EXPECT_EQ(client.request("POST", api + "stop").json()["stopped"], true);
  EXPECT_EQ(client.request("POST", api + "resume").json()["stopped"], false);
  EXPECT_EQ(client.request("PATCH", api + "settings", R"({"mode":"web_only"})").json()["mode"], "web_only");
  EXPECT_EQ(client.request("PUT", api + "pose", R"({"global":true})").status, 200);
  EXPECT_EQ(client.request("PUT", api + "pose", R"({"x":900,"y":0,"theta":0})").json()["code"], "off_the_map");
  int refused = 0;
  for (int i = 0; i < 8; ++i)
    refused += HttpClient(house.port).post(api + "session", {{"password", "x"}}).status == 429;
  EXPECT_GT(refused, 0);
}

TEST(Rest, TakesThisMachineForStaffWithoutAPasswordButNobodyElse) {
  WebHouse house;
  HttpClient here(house.port), bent(house.port, "evil.example");
  EXPECT_EQ(here.get(api + "session").json()["staff"], true);
  EXPECT_EQ(bent.get(api + "session").json()["staff"], false) << "a foreign name that was bent to this address";
  EXPECT_EQ(here.get(api + "session", {{"X-Forwarded-For", "10.0.0.9"}}).json()["staff"], false);
  EXPECT_EQ(here.request("POST", api + "stop", "", {{"Origin", "http://evil.example"}}).status, 403);
  EXPECT_EQ(here.request("POST", api + "stop", "", {{"Sec-Fetch-Site", "cross-site"}}).status, 403);
}

TEST(Rest, LimitsHowOftenSomebodyAsks) {
  server::WebOptions options;
  options.limits.per_session = {3.0, 0.5};
  WebHouse house(options);
  HttpClient client(house.port), other(house.port);
  client.get(api + "session");
  int refused = 0;
  for (int i = 0; i < 6; ++i) {
    const auto answer = client.post(api + "queue", {{"exhibit", "orrery"}});
    if (answer.status != 429) continue;
    ++refused;
    EXPECT_GE(std::stoi(answer.header("retry-after")), 1);
  }
  EXPECT_GE(refused, 2);
  EXPECT_EQ(other.post(api + "queue", {{"exhibit", "orrery"}}).status, 201) << "others are not held up";
}

TEST(Rest, AnswersByTheTableOfRoutes) {
  WebHouse house;
  HttpClient client(house.port);
  EXPECT_EQ(client.get(api + "nothing").status, 404);
  const auto wrong = client.request("PUT", api + "queue", "{}");
  EXPECT_EQ(wrong.status, 405);
  EXPECT_EQ(wrong.header("allow"), "GET, HEAD, OPTIONS, POST");
  EXPECT_EQ(client.request("OPTIONS", api + "queue").status, 204);
  EXPECT_EQ(client.get(api + "status", {{"Accept", "image/png"}}).status, 406);
  EXPECT_EQ(client.get(api + "status", {{"Accept", "text/html, */*;q=0.1"}}).status, 200);
  EXPECT_EQ(client.request("POST", api + "queue", "{}", {{"Content-Type", "text/plain"}}).status, 415);
  const auto head = client.request("HEAD", api + "site");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(head.header("content-length"), std::to_string(client.get(api + "site").body.size()));
}

TEST(Rest, RunsTours) {
  WebHouse house;
  HttpClient client(house.port), stranger(house.port, "docent.example");
  EXPECT_EQ(client.get(api + "tours/current").status, 404);
  EXPECT_EQ(client.post(api + "tours/current", {{"tour", "endless"}}).json()["code"], "unknown_tour");
  const auto made = client.post(api + "tours/current", {{"tour", "short"}, {"name", "Ada"}});
  ASSERT_EQ(made.status, 201);
  EXPECT_EQ(made.json()["stops"], 2);
  EXPECT_EQ(client.get(api + "tours/current").json()["stop"], 1);
  EXPECT_EQ(stranger.post(api + "tours/current/answer", {{"answer", "more"}}).status, 403);
  EXPECT_EQ(client.post(api + "tours/current/answer", {{"answer", "more"}}).status, 200);
  EXPECT_EQ(client.post(api + "tours/current/answer", {{"answer", "maybe"}}).json()["code"], "bad_answer");
  EXPECT_EQ(client.request("DELETE", api + "tours/current").status, 200);
  EXPECT_EQ(client.get(api + "tours/current").status, 404);
}

TEST(Rest, ReportsStatusStatisticsAndHealth) {
  WebHouse house;
  HttpClient client(house.port);
  EXPECT_EQ(client.get("/healthz").status, 503) << "the robot has not been heard";
  robot::PoseEstimate pose;
  pose.localized = true;
  for (int i = 0; i <= 10; ++i) {
    pose.time = robot::from_seconds(i * 0.1);
    pose.twist.linear = 0.5;
    pose.map_from_base = {0.05 * i, 0.0, std::nan("")};
    house.say({pose, robot::Status{}}, i * 0.1);
  }
  house.say({robot::VisitEnded{"orrery", {1}, robot::from_seconds(0), robot::from_seconds(20), true},
             robot::Note{robot::Severity::warning, "bumped", "Somebody leant on it."}});
  EXPECT_EQ(client.get("/healthz").status, 200);
  EXPECT_EQ(client.get("/readyz").status, 200);
  const Json status = client.get(api + "status").json();
  EXPECT_EQ(status["pose"]["theta"], nullptr) << "JSON carries no NaN";
  EXPECT_EQ(status["activity"], "starting");
  EXPECT_EQ(status["battery"], nullptr);
  EXPECT_FALSE(status["sentence"]["en"].get<std::string>().empty());
  const Json statistics = client.get(api + "statistics").json();
  EXPECT_NEAR(statistics["distance_m"].get<double>(), 0.5, 0.051);
  EXPECT_EQ(statistics["exhibits"][0]["visits"], 1);
  house.on_web([&] { house.web().devices({{"base", true, "", 0.05, 10.0}}); });
  const Json health = client.get(api + "health").json();
  EXPECT_EQ(health["devices"][0]["device"], "base");
  EXPECT_EQ(health["notes"][0]["code"], "bumped");
  const auto metrics = client.get("/metrics");
  EXPECT_THAT(metrics.body, testing::HasSubstr("docent_robot_batches_total 12"));
  EXPECT_THAT(metrics.body, testing::HasSubstr("docent_http_request_seconds_bucket"));
}

TEST(Rest, ServesPagesAndPicturesButNothingElse) {
  const TemporaryFolder pages, site;
  std::filesystem::create_directories(pages.path() / "assets");
  std::filesystem::create_directories(site.path() / "pictures");
  const std::string script(5000, 'x');
  pages.write("index.html", "<!doctype html>visit");
  pages.write("kiosk.html", "<!doctype html>kiosk");
  pages.write("assets/visit-K3JQ7XWM.js", script);
  pages.write(".secret.txt", "no");
  site.write("pictures/it.svg", "<svg/>");
  site.write("site.toml", "secret = 1");
  site.write("notes.txt", "secret");
  server::WebOptions options;
  options.pages = pages.path().string();
  options.site = site.path().string();
  WebHouse house(options);
  HttpClient client(house.port);
  const auto page = client.get("/");
  EXPECT_EQ(page.body, "<!doctype html>visit");
  EXPECT_THAT(page.header("content-security-policy"),
              testing::StartsWith("default-src 'self'; img-src 'self' blob: data:"));
  EXPECT_EQ(page.header("x-content-type-options"), "nosniff");
  EXPECT_THAT(page.header("set-cookie"), testing::HasSubstr("HttpOnly; SameSite=Lax"));
  EXPECT_EQ(client.get("/kiosk").body, "<!doctype html>kiosk");
  EXPECT_EQ(client.get("/console").status, 404);
  const auto asset = client.get("/assets/visit-K3JQ7XWM.js", {{"Accept-Encoding", "gzip, br"}});
  EXPECT_EQ(asset.header("content-encoding"), "br");
  EXPECT_LT(asset.body.size(), 200u);
  EXPECT_THAT(asset.header("cache-control"), testing::HasSubstr("immutable"));
  EXPECT_EQ(client.get("/assets/visit-K3JQ7XWM.js", {{"Accept-Encoding", "br;q=0, gzip"}}).header("content-encoding"),
            "gzip");
  EXPECT_EQ(client.get("/assets/visit-K3JQ7XWM.js").body, script);
  EXPECT_EQ(client.get("/", {{"If-None-Match", page.header("etag")}}).status, 304);
  const auto picture = client.get("/site/pictures/it.svg");
  EXPECT_EQ(picture.header("content-type"), "image/svg+xml");
  EXPECT_THAT(picture.header("content-security-policy"), testing::HasSubstr("sandbox"));
  for (const char* path :
       {"/site/site.toml", "/site/notes.txt", "/.secret.txt", "/site/../site.toml", "/..%2f..%2fetc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd", "/site/%00", "/assets/..\\..\\x", "/site//etc/passwd", "/%"}) {
    EXPECT_THAT(client.get(path).status, testing::AnyOf(400, 404)) << path;
  }
  EXPECT_EQ(client.request("POST", "/").status, 405);
}

TEST(Rest, ShowsPictures) {
  WebHouse house;
  HttpClient client(house.port);
  EXPECT_EQ(client.get(api + "cameras").json()[1]["kind"], "wall");
  EXPECT_EQ(client.get(api + "cameras/none/frame.jpg").status, 404);
  EXPECT_FALSE(house.web().camera_wanted("hall"));
  const auto jpeg = std::make_shared<const std::string>("not really a jpeg");
  house.on_web([&] { house.web().frame("hall", jpeg, robot::Time{}); });
  const auto picture = client.get(api + "cameras/hall/frame.jpg");
  EXPECT_EQ(picture.header("content-type"), "image/jpeg");
  EXPECT_EQ(picture.body, *jpeg);
  EXPECT_TRUE(house.web().camera_wanted("hall"));
  EXPECT_FALSE(house.web().camera_wanted("front"));

  testing_support::RawLine line(house.port);
  line.send("GET /api/v1/cameras/hall/stream.mjpg HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_THAT(line.read(std::chrono::seconds(5), "not really a jpeg"), testing::HasSubstr("--docent-frame"));
  house.on_web([&] { house.web().frame("hall", std::make_shared<const std::string>("second"), robot::Time{}); });
  EXPECT_THAT(line.read(std::chrono::seconds(5), "second"), testing::HasSubstr("Content-Length: 6\r\n\r\nsecond"));
}

}  // namespace
