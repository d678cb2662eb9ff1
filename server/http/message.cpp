#include "server/http/message.hpp"

namespace server {

Reply json_reply(const protocols::web::Json& json, int status) {
  // Whatever text got in: replace what is not UTF-8 rather than throw.
  auto text = json.dump(-1, ' ', false, protocols::web::Json::error_handler_t::replace);
  Reply reply = text_reply(std::move(text), "application/json", status);
  return reply.with("Cache-Control", "no-store");
}

Reply text_reply(std::string text, std::string content_type, int status) {
  Reply reply;
  reply.status = status;
  reply.content_type = std::move(content_type);
  reply.body = std::make_shared<const std::string>(std::move(text));
  return reply;
}

Reply problem_reply(const protocols::web::Problem& problem) {
  Reply reply = json_reply(protocols::web::encode(problem), problem.status);
  reply.content_type = "application/problem+json";
  return reply;
}

}  // namespace server
