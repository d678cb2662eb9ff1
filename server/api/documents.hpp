// The documents that describe the wire, as they are served.
#pragma once

#include <string>

#include "protocols/web/problem.hpp"

namespace server {

extern const char* const openapi_yaml;   // protocols/web/openapi.yaml, compiled in
extern const char* const asyncapi_yaml;  // protocols/web/asyncapi.yaml

// YAML (core schema scalars) as JSON. Throws std::runtime_error with line and column.
protocols::web::Json yaml_to_json(const std::string& yaml);

}  // namespace server
