// Checks a JSON value against the part of JSON Schema that openapi.yaml and asyncapi.yaml use. Unknown keywords fail,
// so that nothing is silently unchecked.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace testing_support {

class SchemaChecker {
 public:
  using Json = nlohmann::ordered_json;

  // `document`: where "#/..." references point into.
  explicit SchemaChecker(const Json& document) : document_(document) {}

  // What is wrong, one line each; empty: the value fits.
  std::vector<std::string> check(const Json& value, const Json& schema) const {
    std::vector<std::string> errors;
    check(value, schema, "$", errors);
    return errors;
  }
  const Json& resolve(const Json& node) const {
    if (!node.is_object() || !node.contains("$ref")) return node;
    return resolve(document_.at(Json::json_pointer(node.at("$ref").get<std::string>().substr(1))));
  }

 private:
  static bool is_of(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "number") return value.is_number();
    if (type == "integer") return value.is_number() && value.get<double>() == std::floor(value.get<double>());
    throw std::runtime_error("schema: unknown type " + type);
  }

  void check(const Json& value, const Json& node, const std::string& where, std::vector<std::string>& errors) const {
    const Json& schema = resolve(node);
    for (const auto& [keyword, rule] : schema.items()) apply(keyword, rule, schema, value, where, errors);
  }

  void apply(const std::string& keyword, const Json& rule, const Json& schema, const Json& value,
             const std::string& where, std::vector<std::string>& errors) const {
    const auto wrong = [&](const std::string& what) {
      errors.push_back(where + ": " + what + ", got " + value.dump().substr(0, 80));
    };
    static const std::set<std::string> words{"description", "summary", "format", "x-sample", "examples"};
    if (words.contains(keyword)) return;
    if (keyword == "type") {
      bool fits = false;
      for (const Json& type : rule.is_array() ? rule : Json::array({rule})) fits = fits || is_of(value, type);
      if (!fits) wrong("must be " + rule.dump());
    } else if (keyword == "enum") {
      if (std::find(rule.begin(), rule.end(), value) == rule.end()) wrong("must be one of " + rule.dump());
    } else if (keyword == "const") {
      if (value != rule) wrong("must be " + rule.dump());
    } else if (keyword == "required") {
      for (const Json& name : rule) {
        if (value.is_object() && !value.contains(name.get<std::string>())) wrong("lacks " + name.dump());
      }
    } else if (keyword == "properties") {
      for (const auto& [name, property] : rule.items()) {
        if (value.is_object() && value.contains(name)) check(value.at(name), property, where + "." + name, errors);
      }
    } else if (keyword == "additionalProperties") {
      if (!value.is_object()) return;
      for (const auto& [name, entry] : value.items()) {
        if (schema.contains("properties") && schema.at("properties").contains(name)) continue;
        if (rule.is_boolean()) {
          if (!rule.get<bool>()) wrong("must not have " + name);
        } else {
          check(entry, rule, where + "." + name, errors);
        }
      }
    } else if (keyword == "items") {
      if (!value.is_array()) return;
      for (std::size_t i = 0; i < value.size(); ++i)
        check(value[i], rule, where + "[" + std::to_string(i) + "]", errors);
    } else if (keyword == "oneOf") {
      int fitting = 0;
      for (const Json& choice : rule) fitting += check(value, choice).empty();
      if (fitting != 1) wrong("must fit exactly one of " + rule.dump());
    } else {
      bounds(keyword, rule, value, wrong);
    }
  }

  template <typename Wrong>
  static void bounds(const std::string& keyword, const Json& rule, const Json& value, const Wrong& wrong) {
    if (keyword == "minimum") {
      if (value.is_number() && value.get<double>() < rule.get<double>()) wrong("must be at least " + rule.dump());
    } else if (keyword == "maximum") {
      if (value.is_number() && value.get<double>() > rule.get<double>()) wrong("must be at most " + rule.dump());
    } else if (keyword == "minItems") {
      if (value.is_array() && value.size() < rule.get<std::size_t>()) wrong("needs " + rule.dump() + " entries");
    } else if (keyword == "maxItems") {
      if (value.is_array() && value.size() > rule.get<std::size_t>()) wrong("takes " + rule.dump() + " entries");
    } else if (keyword == "maxLength") {
      if (value.is_string() && value.get<std::string>().size() > rule.get<std::size_t>()) wrong("is too long");
    } else {
      throw std::runtime_error("schema: unknown keyword " + keyword);
    }
  }

  const Json& document_;
};

}  // namespace testing_support
