#include "io/read/yaml_map.hpp"

#include <algorithm>

#include "io/read/yaml_node.hpp"

namespace pirsim::io {

YamlMap::YamlMap(YamlNode node, Diagnostics& faults, std::string what)
    : node_(std::move(node)), faults_(&faults), what_(std::move(what)) {
  if (!node_.is_map() && !node_.is_null()) faults.error(node_.where(), what_ + ": expected a map of keys and values");
}

Where YamlMap::where(const std::string& key) const {
  const std::optional<YamlNode> node = find(key);
  return node ? node->where() : where();
}
bool YamlMap::has(const std::string& key) const { return find(key).has_value(); }

std::string YamlMap::label(const std::string& key) const { return what_ + ": " + key; }

std::optional<YamlNode> YamlMap::find(const std::string& key) const { return node_.value_of(key); }

std::optional<YamlNode> YamlMap::child(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  return find(key);
}
void YamlMap::require(const std::string& key) {
  if (!child(key)) report_missing(key);
}
void YamlMap::report_missing(const std::string& key) const {
  if (node_.is_map() || node_.is_null()) faults_->error(where(), what_ + ": '" + key + "' is missing");
}
YamlNode YamlMap::required_child(const std::string& key) {
  if (std::optional<YamlNode> node = child(key)) return *node;
  report_missing(key);
  return YamlNode(std::make_shared<const YamlTree>());
}

double YamlMap::number(const std::string& key, double otherwise, NumberRange range) {
  return optional_number(key, range).value_or(otherwise);
}
double YamlMap::required_number(const std::string& key, NumberRange range) {
  if (const std::optional<double> value = optional_number(key, range)) return *value;
  report_missing(key);
  return 0.0;
}
std::optional<double> YamlMap::optional_number(const std::string& key, NumberRange range) {
  const std::optional<YamlNode> node = child(key);
  if (!node) return std::nullopt;
  return node->number(*faults_, label(key), range);
}
int YamlMap::integer(const std::string& key, int otherwise, IntegerRange range) {
  const std::optional<YamlNode> node = child(key);
  return node ? static_cast<int>(node->integer(*faults_, label(key), range)) : otherwise;
}
int YamlMap::required_integer(const std::string& key, IntegerRange range) {
  if (!has(key)) report_missing(key);
  return integer(key, 0, range);
}
std::uint64_t YamlMap::unsigned_integer(const std::string& key, std::uint64_t otherwise) {
  const std::optional<YamlNode> node = child(key);
  if (!node) return otherwise;
  return static_cast<std::uint64_t>(
      node->integer(*faults_, label(key), {.min = 0, .max = std::numeric_limits<long long>::max()}));
}
bool YamlMap::flag(const std::string& key, bool otherwise) {
  const std::optional<YamlNode> node = child(key);
  return node ? node->flag(*faults_, label(key)) : otherwise;
}
std::string YamlMap::text(const std::string& key, std::string otherwise) {
  const std::optional<YamlNode> node = child(key);
  return node ? node->text(*faults_, label(key)) : otherwise;
}
std::string YamlMap::prose(const std::string& key, std::string otherwise) {
  const std::optional<YamlNode> node = child(key);
  return node ? node->prose(*faults_, label(key)) : otherwise;
}
std::string YamlMap::required_text(const std::string& key) {
  const std::optional<YamlNode> node = child(key);
  if (!node) {
    report_missing(key);
    return {};
  }
  std::string value = node->text(*faults_, label(key));
  if (node->is_scalar() && value.empty())
    faults_->error(node->where(), label(key) + ": expected a text that isn't empty");
  return value;
}

std::vector<double> YamlMap::numbers(const std::string& key, std::vector<double> otherwise, NumberRange range) {
  const std::optional<YamlNode> node = child(key);
  return node ? read_numbers(*node, *faults_, label(key), range) : otherwise;
}
std::vector<double> YamlMap::required_numbers(const std::string& key, std::size_t size, NumberRange range) {
  const std::optional<YamlNode> node = child(key);
  if (!node) {
    report_missing(key);
    return std::vector<double>(size, 0.0);
  }
  std::vector<double> values = read_numbers(*node, *faults_, label(key), range);
  if (node->is_list() && values.size() != size) {
    faults_->error(node->where(), label(key) + ": expected " + std::to_string(size) + " numbers, got " +
                                      std::to_string(values.size()));
  }
  values.resize(size, 0.0);
  return values;
}
std::vector<std::string> YamlMap::texts(const std::string& key, std::vector<std::string> otherwise) {
  if (!child(key)) return otherwise;
  std::vector<std::string> values;
  for (const YamlNode& item : list(key)) {
    values.push_back(item.text(*faults_, label(key)));
    if (std::ranges::find(values.begin(), values.end() - 1, values.back()) == values.end() - 1) continue;
    faults_->error(item.where(), label(key) + ": '" + values.back() + "' is named twice");
  }
  return values;
}

std::vector<YamlNode> YamlMap::list(const std::string& key, std::size_t most) {
  const std::optional<YamlNode> node = child(key);
  if (!node || node->is_null()) return {};
  return read_list(*node, *faults_, label(key), most);
}
std::vector<YamlNode> YamlMap::required_list(const std::string& key, std::size_t most) {
  const std::optional<YamlNode> node = child(key);
  if (!node) {
    report_missing(key);
    return {};
  }
  if (node->is_null() || (node->is_list() && node->n_items() == 0)) {
    faults_->error(node->where(), label(key) + ": expected a list that isn't empty");
  }
  return list(key, most);
}

namespace {

/// Leaves out what was told at that place in these words.
void take_back(Diagnostics& faults, const Where& where, const std::string& message) {
  Diagnostics kept;
  for (const Issue& issue : faults.issues()) {
    if (issue.where == where && issue.message == message) continue;
    issue.severity == Severity::error ? kept.error(issue.where, issue.message)
                                      : kept.warning(issue.where, issue.message);
  }
  faults = std::move(kept);
}

}  // namespace

void YamlMap::finish() const {
  for (const YamlKey& key : node_.keys()) {
    if (std::find(asked_.begin(), asked_.end(), key.name) != asked_.end()) continue;
    const std::string meant = did_you_mean(key.name, asked_);
    for (const std::string& asked : asked_) {  // the key that is meant is misspelt, and not missing as well
      if (!meant.empty() && did_you_mean(key.name, {asked}) == meant)
        take_back(*faults_, where(), what_ + ": '" + asked + "' is missing");
    }
    faults_->error(key.where, what_ + ": unknown key '" + key.name + "'" + meant);
  }
}

std::string too_many(std::size_t most, const std::string& what) {
  return "more than " + std::to_string(most) + ' ' + what;
}

std::vector<YamlNode> read_list(const YamlNode& node, Diagnostics& faults, const std::string& what, std::size_t most) {
  if (!node.is_list()) {
    faults.error(node.where(), what + ": expected a list");
    return {};
  }
  if (node.n_items() <= most) return node.items();
  faults.error(node.where(), what + ": " + too_many(most, "entries") + ", namely " + std::to_string(node.n_items()));
  return {};
}

std::vector<double> read_numbers(const YamlNode& node, Diagnostics& faults, std::string_view what, NumberRange range) {
  if (!node.is_list()) {
    faults.error(node.where(), std::string(what) + ": expected a list of numbers");
    return {};
  }
  std::vector<double> values;
  for (const YamlNode& item : read_list(node, faults, std::string(what)))
    values.push_back(item.number(faults, what, range));
  return values;
}

}  // namespace pirsim::io
