// The web server's parts in one place, for the route files. Not for use outside server/api.
#pragma once

#include <set>

#include "server/api/desk.hpp"
#include "server/api/journal.hpp"
#include "server/api/metrics.hpp"
#include "server/api/sessions.hpp"
#include "server/api/view.hpp"
#include "server/api/web.hpp"
#include "server/http/files.hpp"
#include "server/http/router.hpp"

namespace server {

class Web::Parts {
 public:
  using Json = protocols::web::Json;

  Parts(net::io_context& web_context, robot::Museum its_museum, WebOptions its_options, Submit submit);

  net::awaitable<Reply> answer(Call& call);
  // 503 for what the robot or the disk did not do in time.
  static Reply unavailable(std::string code, std::string detail);
  // A document that does not change while the server runs, with its ETag; made once a key.
  Reply document(const Call& call, const std::string& key, const std::function<Json()>& make);
  Reply document(const Call& call, const std::string& key, const std::string& content_type,
                 const std::function<std::string()>& make);
  // ?lang=, when the museum speaks it; else English.
  std::string language(const Call& call) const;
  // The name to put on a request: as given (and then remembered), or the session's.
  std::string name_for(const Call& call, const std::optional<std::string>& given);
  robot::Requester requester(const Call& call, const std::optional<std::string>& name);
  // Runs `make` once an Idempotency-Key; what it answered with success is given again, also after a crash. Answers of
  // success go out only when everything said to the journal is on the disk; `undo` is called when that fails.
  net::awaitable<Reply> durable(Call& call, std::function<net::awaitable<Reply>()> make, std::function<void()> undo);
  // Waits for the robot's next batch.
  net::awaitable<void> next_batch(Clock::duration patience);
  double robot_age() const;  // s since the last batch
  bool robot_alive() const;
  Json health() const;
  bool may_answer_tour(const Call& call) const;

  net::io_context& context;
  const robot::Museum museum;
  const WebOptions options;
  std::vector<std::string> languages;
  Hub hub;
  Cameras cameras;
  std::unique_ptr<Journal> journal;
  robot::Remember remembered;
  std::unique_ptr<View> view;
  Desk desk;
  Sessions sessions;
  Metrics metrics;
  Files pages, site;
  Router router;
  std::shared_ptr<HttpServer> http;
  std::vector<DeviceHealth> devices;
  Clock::time_point heard_robot = Clock::time_point::min();
  net::steady_timer batch_arrival;
  net::steady_timer second;
  std::uint64_t seconds = 0;
  std::size_t told_viewers = SIZE_MAX;
  bool stopping = false;

  void every_second();

 private:
  struct Document {
    std::string etag;
    std::string content_type;
    std::shared_ptr<const std::string> plain, packed;
  };

  void open_store();
  void identify(Call& call, std::optional<std::string>& fresh_cookie);
  bool is_local(const Call& call) const;
  // A change asked for by a foreign page, or too often; status 200: go on.
  protocols::web::Problem refuse_change(const Call& call, int& retry_after);
  Reply page(const Call& call);
  void secure(const Call& call, Reply& reply) const;

  std::map<std::string, Document> documents_;
  std::set<std::string> keys_in_progress_;
};

// The routes, by what they are about.
void add_museum_routes(Router& router, Web::Parts& web);
void add_queue_routes(Router& router, Web::Parts& web);
void add_tour_routes(Router& router, Web::Parts& web);
void add_control_routes(Router& router, Web::Parts& web);
void add_camera_routes(Router& router, Web::Parts& web);
void add_session_routes(Router& router, Web::Parts& web);
void add_report_routes(Router& router, Web::Parts& web);
void add_stream_routes(Router& router, Web::Parts& web);

// Whether a call was made by this server's own page, or by no page at all.
bool is_same_origin(const Call& call);
// A Set-Cookie value for a session's cookie.
std::string cookie_header(const Call& call, const std::string& cookie);

// Handlers that need not wait.
Handler at_once(std::function<Reply(Call&)> handler);
// The same, for staff only.
Handler for_staff(Handler handler);

}  // namespace server
