#include "server/api/parts.hpp"

#include <spdlog/spdlog.h>

#include <set>

#include "protocols/web/encode.hpp"

namespace server {
namespace {

using protocols::web::Problem;

std::vector<std::string> camera_ids(const std::vector<CameraInfo>& cameras) {
  std::vector<std::string> ids;
  ids.reserve(cameras.size());
  for (const auto& camera : cameras) ids.push_back(camera.id);
  return ids;
}

std::vector<std::string> languages_of(const robot::Museum& museum) {
  std::set<std::string> languages{"en"};
  for (const auto& [language, text] : museum.title) languages.insert(language);
  for (const auto& exhibit : museum.exhibits) {
    for (const auto& [language, text] : exhibit.title) languages.insert(language);
  }
  return {languages.begin(), languages.end()};
}

// "http://robot:8080/kiosk?x" -> "/kiosk".
std::string_view path_of_url(std::string_view url) {
  const std::size_t host = url.find("://");
  if (host == std::string_view::npos) return {};
  url.remove_prefix(host + 3);
  const std::size_t path = url.find('/');
  if (path == std::string_view::npos) return "/";
  url.remove_prefix(path);
  return url.substr(0, url.find_first_of("?#"));
}

}  // namespace

Web::Parts::Parts(net::io_context& web_context, robot::Museum its_museum, WebOptions its_options, Submit submit)
    : context(web_context),
      museum(std::move(its_museum)),
      options(std::move(its_options)),
      languages(languages_of(museum)),
      hub(new_cookie(), camera_ids(options.cameras)),
      cameras(context.get_executor(), options.cameras, hub),
      desk(context, std::move(submit)),
      sessions(
          {options.limits.per_session, options.limits.per_address, options.limits.passwords, options.limits.sessions}),
      batch_arrival(context, Clock::time_point::max()),
      second(context) {
  open_store();
  if (!options.pages.empty()) pages = Files(options.pages);
  if (!options.site.empty()) site = Files(options.site, {.media_only = true});
  for (const auto add : {add_museum_routes, add_queue_routes, add_tour_routes, add_control_routes, add_camera_routes,
                         add_session_routes, add_report_routes, add_stream_routes}) {
    add(router, *this);
  }
}

void Web::Parts::open_store() {
  auto store = std::make_unique<Store>(options.database, wall_now());
  if (!store->notice().empty()) spdlog::error("{}", store->notice());
  store->tidy(wall_now());
  const std::vector<StoredRequest> open = store->open_requests();
  std::vector<StoredRequest> all = store->ended_requests(100);
  std::reverse(all.begin(), all.end());
  all.insert(all.end(), open.begin(), open.end());
  remembered.next_id = store->next_request_id();
  for (const auto& stored : open) {
    remembered.open.push_back({stored.request.id, stored.request.requester, stored.request.target});
  }
  const StoredStatistics past = store->statistics();
  for (auto& name : store->names(10'000)) sessions.set_name(name.session, std::move(name.name));
  journal = std::make_unique<Journal>(context, std::move(store));
  view = std::make_unique<View>(museum, hub, *journal, past, all);
}

void Web::Parts::every_second() {
  second.expires_after(std::chrono::seconds(1));
  second.async_wait([this](error_code error) {
    if (error || stopping) return;
    ++seconds;
    hub.tell_laggards();
    cameras.update_wanted();
    Json message = {{"type", "health"}};
    message.update(health());
    hub.state(index(Topic::health), message);
    if (const std::size_t viewers = hub.viewers(); viewers != told_viewers) {
      told_viewers = viewers;
      hub.state(index(Topic::viewers), {{"type", "viewers"}, {"count", viewers}});
    }
    if (seconds % 10 == 0) view->save_travel();
    if (seconds % 60 == 0) sessions.tidy(Clock::now());
    if (seconds % 3600 == 0) journal->write([now = wall_now()](Store& store) { store.tidy(now); });
    every_second();
  });
}

net::awaitable<void> Web::Parts::next_batch(Clock::duration patience) {
  using namespace net::experimental::awaitable_operators;
  net::steady_timer deadline(context, patience);
  co_await (batch_arrival.async_wait(net::as_tuple(net::use_awaitable)) ||
            deadline.async_wait(net::as_tuple(net::use_awaitable)));
}

double Web::Parts::robot_age() const {
  if (heard_robot == Clock::time_point::min()) return std::numeric_limits<double>::infinity();
  return std::chrono::duration<double>(Clock::now() - heard_robot).count();
}

bool Web::Parts::robot_alive() const {
  return robot_age() < std::chrono::duration<double>(options.limits.robot_silence).count();
}

Web::Parts::Json Web::Parts::health() const {
  Json lines = Json::array();
  for (const DeviceHealth& device : devices) {
    lines.push_back({{"device", device.device},
                     {"connected", device.connected},
                     {"reason", device.reason},
                     {"age_seconds", protocols::web::number(device.age_seconds, 2)},
                     {"rate_hz", protocols::web::number(device.rate_hz, 1)},
                     {"bad_packets", device.bad_packets}});
  }
  return {{"devices", lines},
          {"localization", view->localization_json()},
          {"viewers", hub.viewers()},
          {"robot_age_seconds", protocols::web::number(robot_age(), 2)},
          {"database", journal->healthy()},
          {"notes", view->notes_json()}};
}

std::string Web::Parts::language(const Call& call) const {
  const auto wanted = call.query_value("lang");
  return wanted && std::find(languages.begin(), languages.end(), *wanted) != languages.end() ? *wanted : "en";
}

std::string Web::Parts::name_for(const Call& call, const std::optional<std::string>& given) {
  if (!given) return sessions.name(call.session);
  if (*given != sessions.name(call.session)) {
    sessions.set_name(call.session, *given);
    journal->write(
        [name = StoredName{call.session, *given}, now = wall_now()](Store& store) { store.put_name(name, now); });
  }
  return *given;
}

robot::Requester Web::Parts::requester(const Call& call, const std::optional<std::string>& name) {
  robot::Requester requester{name_for(call, name), robot::Channel::web, call.session};
  const std::string_view page_path = path_of_url(call.header("Referer"));
  if (page_path == "/kiosk") {
    requester.channel = robot::Channel::kiosk;
  } else if (page_path == "/console") {
    requester.channel = robot::Channel::console;
  } else if (page_path.empty()) {
    requester.channel = robot::Channel::program;
  }
  return requester;
}

bool Web::Parts::may_answer_tour(const Call& call) const {
  return call.staff || view->takes_part(call.session) || path_of_url(call.header("Referer")) == "/kiosk";
}

Reply Web::Parts::unavailable(std::string code, std::string detail) {
  Reply reply = problem_reply({503, std::move(code), std::move(detail), ""});
  return reply.with("Retry-After", "2");
}

Reply Web::Parts::document(const Call& call, const std::string& key, const std::function<Json()>& make) {
  return document(call, key, "application/json", [&] { return make().dump(); });
}

Reply Web::Parts::document(const Call& call, const std::string& key, const std::string& content_type,
                           const std::function<std::string()>& make) {
  auto it = documents_.find(key);
  if (it == documents_.end()) {
    Document made{{}, content_type, std::make_shared<const std::string>(make()), nullptr};
    made.etag = etag_of(*made.plain);
    if (content_type == "application/json" && made.plain->size() > 1024) {
      made.packed = std::make_shared<const std::string>(gzip(*made.plain));
    }
    it = documents_.emplace(key, std::move(made)).first;
  }
  const Document& known = it->second;
  const bool packed = known.packed && takes_encoding(call.header("Accept-Encoding"), "gzip");
  const std::string etag = "\"" + known.etag + (packed ? "-gz\"" : "\"");
  Reply reply;
  reply.with("ETag", etag).with("Cache-Control", "no-cache").with("Vary", "Accept-Encoding");
  if (matches_etag(call.header("If-None-Match"), etag)) {
    reply.status = 304;
    return reply;
  }
  reply.content_type = known.content_type;
  reply.body = packed ? known.packed : known.plain;
  if (packed) reply.with("Content-Encoding", "gzip");
  return reply;
}

net::awaitable<Reply> Web::Parts::durable(Call& call, std::function<net::awaitable<Reply>()> make,
                                          std::function<void()> undo) {
  const std::string key(call.header("Idempotency-Key"));
  const std::string fingerprint = etag_of(call.method + " " + call.path + " " + call.body);
  if (key.size() > 128) {
    co_return problem_reply(
        {422, "bad_idempotency_key", "An Idempotency-Key has at most 128 characters.", "Idempotency-Key"});
  }
  if (keys_in_progress_.contains(key)) {
    Reply busy = problem_reply({409, "in_progress", "The same request is being worked on; ask again in a moment.", ""});
    co_return busy.with("Retry-After", "1");
  }
  std::shared_ptr<void> in_progress;
  if (!key.empty()) {
    keys_in_progress_.insert(key);
    in_progress = std::shared_ptr<void>(nullptr, [this, key](void*) { keys_in_progress_.erase(key); });
    const std::function<std::optional<StoredAnswer>(Store&)> question = [key](Store& store) {
      return store.find_answer(key);
    };
    const auto given = co_await journal->ask(question);
    if (given && given->fingerprint != fingerprint) {
      co_return problem_reply(
          {422, "idempotency_key_reused", "That Idempotency-Key was used for something else.", "Idempotency-Key"});
    }
    if (given) {
      Reply again = text_reply(given->body, "application/json", given->status);
      if (!given->location.empty()) again.with("Location", given->location);
      co_return again.with("Idempotent-Replayed", "true");
    }
  }
  Reply reply = co_await make();
  if (reply.status >= 300) co_return reply;
  if (!key.empty()) {
    std::string location;
    for (const auto& [name, value] : reply.headers) {
      if (name == "Location") location = value;
    }
    journal->write([key, answer = StoredAnswer{fingerprint, reply.status, *reply.body, location},
                    now = wall_now()](Store& store) { store.put_answer(key, answer, now); });
  }
  if (co_await journal->written()) co_return reply;
  undo();
  co_return unavailable("storage", "The request could not be stored, so it was not accepted; try again later.");
}

Handler at_once(std::function<Reply(Call&)> handler) {
  return [handler = std::move(handler)](Call& call) -> net::awaitable<Reply> { co_return handler(call); };
}

Handler for_staff(Handler handler) {
  return [handler = std::move(handler)](Call& call) -> net::awaitable<Reply> {
    if (call.staff) co_return co_await handler(call);
    co_return problem_reply({403, "staff_only", "Only staff may do that; sign in with POST /api/v1/session.", ""});
  };
}

}  // namespace server
