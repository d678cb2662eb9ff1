#include "protocols/web/problem.hpp"

namespace protocols::web {

const char* status_title(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
    case 204:
      return "No Content";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 406:
      return "Not Acceptable";
    case 408:
      return "Request Timeout";
    case 409:
      return "Conflict";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 415:
      return "Unsupported Media Type";
    case 417:
      return "Expectation Failed";
    case 422:
      return "Unprocessable Content";
    case 426:
      return "Upgrade Required";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Internal Server Error";
  }
}

Json encode(const Problem& problem) {
  Json json = {{"type", "about:blank"},
               {"title", status_title(problem.status)},
               {"status", problem.status},
               {"detail", problem.detail},
               {"code", problem.code}};
  if (!problem.field.empty()) json["field"] = problem.field;
  return json;
}

Problem problem_of(robot::Refusal refusal) {
  using enum robot::Refusal;
  switch (refusal) {
    case unknown_exhibit:
      return {422, "unknown_exhibit", "There is no exhibit of that id; GET exhibits lists them.", "exhibit"};
    case unknown_viewpoint:
      return {422, "unknown_viewpoint", "The exhibit has no viewpoint of that number.", "viewpoint"};
    case unknown_tour:
      return {422, "unknown_tour", "There is no tour of that id; GET tours lists them.", "tour"};
    case not_finite:
      return {422, "not_finite", "Coordinates must be finite numbers in metres.", "x"};
    case off_the_map:
      return {422, "off_the_map", "That point lies off the map or outside the operating area.", "x"};
    case inside_obstacle:
      return {422, "inside_obstacle", "The robot does not fit there: a wall or an exhibit is in the way.", "x"};
    case in_hazard:
      return {422, "in_hazard", "The robot keeps out of that place: it is marked as a hazard.", "x"};
    case unreachable:
      return {422, "unreachable", "There is no way for the robot to get there.", ""};
    case queue_full:
      return {503, "queue_full", "Too many requests are waiting; try again when some have been fulfilled.", ""};
    case unknown_request:
      return {404, "unknown_request", "There is no request of that id.", ""};
    case not_yours:
      return {403, "not_yours", "Only the one who asked, or staff, may change this request.", ""};
    case already_over:
      return {409, "already_over", "That request has already ended.", ""};
    case nothing_to_answer:
      return {409, "nothing_to_answer", "The robot is not asking anything at the moment.", ""};
    case recording:
      return {409, "recording", "This robot repeats a recorded drive; it cannot be sent anywhere.", ""};
    case none:
      break;
  }
  return {500, "internal", "The robot refused without a reason.", ""};
}

}  // namespace protocols::web
