#include "reconcile/ensemble/reference_table.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "files/disk/file.hpp"
#include "model/core/parallel.hpp"
#include "model/core/random.hpp"
#include "model/schema/fingerprint.hpp"
#include "pirsim/error.hpp"
#include "pirsim/version.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t effects_per_attempt = 4096;  ///< keeps the streams of attempts apart
/// What a profile was made of looks less strange beside it than new data do: no realization of a table.
constexpr std::uint32_t first_pilot_realization = 1U << 26U;

/// Number of realizations for calibration before the n-th realization.
std::uint32_t n_for_calibration(std::uint32_t n) {
  std::uint32_t count = n / 5 * 2;
  for (std::uint32_t realization = n / 5 * 5; realization < n; ++realization)
    count += is_for_calibration(realization) ? 1 : 0;
  return count;
}

std::uint32_t place_in_catalogue(const effects::Effect& effect) {
  return static_cast<std::uint32_t>(std::ranges::find(effects::catalogue(), &effect) - effects::catalogue().begin());
}

/// All effects are trained in the same realizations, so that what is between two of them isn't the realizations' doing.
/// They are calibrated in realizations that differ as far as there are enough: a few strange ones shall not set the
/// levels of all.
bool has_dataset(const effects::Effect& effect, std::uint32_t realization, const TableSettings& settings,
                 const ScriptSpec& script) {
  const std::uint32_t wanted =
      effect.info.reach == effects::Reach::geometry ? settings.n_traced : settings.n_remembered;
  if (!is_for_calibration(realization)) return realization < wanted;
  const std::uint32_t n = n_for_calibration(settings.n_realizations);
  const auto first =
      static_cast<std::uint32_t>(std::size_t{place_in_catalogue(effect)} * n / effects::catalogue_for(script).size());
  return (n_for_calibration(realization) + n - first) % n < n_for_calibration(wanted);
}

/// Of one realization; settings.effects names every hypothesis.
TableChunk simulate_datasets(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                             const TableSettings& settings, std::uint32_t index) {
  TableChunk chunk;
  const SimulatedRealization realization(source, frame, index, n_replicates);
  chunk.datasets.push_back({{0, index, {}}, realization.plain(0, n_replicates)});
  for (std::uint32_t e = 0; e < settings.effects.size(); ++e) {
    const effects::Effect& effect = effects::find(settings.effects[e]);
    if (!has_dataset(effect, index, settings, source.script)) continue;
    ++chunk.n_left_out;  // until an attempt gives one
    for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
      // What is drawn for an effect doesn't depend on which others are looked for.
      Stream stream({source.seed, index, place_in_catalogue(effect) + attempt * effects_per_attempt,
                     Purpose::reference_parameters});
      const EffectSpec drawn =
          effects::draw_from_prior(effect, realization.drawn().scene, realization.drawn().script, stream);
      auto data = realization.with_effects(std::span(&drawn, 1), 0, n_replicates);
      if (!data) continue;
      chunk.datasets.push_back({{e + 1, index, {drawn}}, std::move(*data)});
      --chunk.n_left_out;
      break;
    }
  }
  return chunk;
}

// Structured bindings name every field, so that a new one doesn't compile until it stands here.

void add(Fingerprint& print, const DayParts& parts) {
  const auto& [trial, n_days, n_rows, of_row, people, names, begins_s] = parts;
  print.add_each(trial, n_days, n_rows, of_row, people, names, begins_s);
}

void add(Fingerprint& print, const StudyFrame& frame) {
  const auto& [trials, sensors, counted_phases, window_s, parts] = frame;
  print.add_each(trials, sensors, counted_phases, window_s);
  add(print, parts);
}

void add(Fingerprint& print, const TableSettings& settings) {
  const auto& [n_realizations, n_remembered, n_traced, hypotheses] = settings;
  print.add_each(n_realizations, n_remembered, n_traced, hypotheses);
  for (const std::string& hypothesis : hypotheses) {  // and what is drawn of them
    for (const effects::ParameterInfo& parameter : effects::find(hypothesis).info.parameters)
      print.add_each(parameter.name, parameter.low, parameter.high, parameter.scale);
  }
}

constexpr std::uint32_t items_per_chunk = 25;

// A chunk on disk: its table's key and its number, then everything in it, then the digest of all that. Numbers lie as
// in memory; texts and lists come after their size. The same lines write and read.

static_assert(std::endian::native == std::endian::little, "the byte order of the format is that of the machine");

struct Packing {
  static constexpr bool reads = false;
  std::string bytes;
  void raw(const void* from, std::size_t n) { bytes.append(static_cast<const char*>(from), n); }
};

struct Unpacking {
  static constexpr bool reads = true;
  std::string_view bytes;
  void raw(void* to, std::size_t n) {
    if (n > bytes.size()) throw Error(ErrorCode::input, "the reference table ends too early");
    bytes.copy(static_cast<char*>(to), n);
    bytes.remove_prefix(n);
  }
};

/// A number as another kind of number on disk.
template <typename Stored, typename Bytes, typename Number>
void pass_as(Bytes& bytes, Number& number) {
  auto stored = static_cast<Stored>(number);
  bytes.raw(&stored, sizeof stored);
  if constexpr (Bytes::reads) number = static_cast<Number>(stored);
}

/// Reading, the list gets that size.
template <typename Bytes, typename List>
void pass_size(Bytes& bytes, List& list) {
  auto n = static_cast<std::uint32_t>(list.size());
  pass_as<std::uint32_t>(bytes, n);
  if constexpr (Bytes::reads) list.resize(n);
}

template <typename Bytes, typename Text>
void pass_text(Bytes& bytes, Text& text) {
  pass_size(bytes, text);
  bytes.raw(text.data(), text.size());
}

template <typename Bytes, typename Map, typename Pass>
void pass_named(Bytes& bytes, Map& map, const Pass& pass_value) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  pass_size(bytes, names);
  for (std::string& name : names) {
    pass_text(bytes, name);
    if constexpr (Bytes::reads) map[name];
    pass_value(map.find(name)->second);
  }
}

template <typename Bytes, typename Effect>
void pass_effect(Bytes& bytes, Effect& effect) {
  pass_text(bytes, effect.name);
  pass_named(bytes, effect.parameters, [&](auto& value) { pass_as<double>(bytes, value); });
  pass_named(bytes, effect.choices, [&](auto& word) { pass_text(bytes, word); });
}

/// Eight bits a byte; simulated data know all of them.
template <typename Bytes, typename Run>
void pass_run(Bytes& bytes, Run& run) {
  for (auto* number : {&run.trial, &run.main_begin, &run.main_end}) pass_as<std::uint32_t>(bytes, *number);
  pass_as<std::int32_t>(bytes, run.replicate);
  pass_size(bytes, run.bits);
  for (std::size_t first = 0; first < run.bits.size(); first += 8) {
    const auto eight = std::span(run.bits).subspan(first, std::min<std::size_t>(8, run.bits.size() - first));
    unsigned packed = 0;
    for (std::size_t i = 0; i < eight.size(); ++i) packed |= (eight[i] == 1 ? 1U : 0U) << i;
    pass_as<std::uint8_t>(bytes, packed);
    if constexpr (Bytes::reads) {
      for (std::size_t i = 0; i < eight.size(); ++i) eight[i] = packed >> i & 1U;
    }
  }
}

template <typename Bytes, typename Chunk>
void pass_chunk(Bytes& bytes, Chunk& chunk) {
  pass_as<std::uint32_t>(bytes, chunk.n_left_out);
  pass_size(bytes, chunk.datasets);
  for (auto& [row, runs] : chunk.datasets) {
    for (auto* number : {&row.hypothesis, &row.realization}) pass_as<std::uint32_t>(bytes, *number);
    pass_size(bytes, row.effects);
    for (auto& effect : row.effects) pass_effect(bytes, effect);
    pass_size(bytes, runs);
    for (auto& run : runs) pass_run(bytes, run);
  }
}

/// With whose chunk it is.
std::string packed(const TableChunk& chunk, const std::string& key, std::uint32_t number) {
  Packing bytes;
  pass_text(bytes, key);
  pass_as<std::uint32_t>(bytes, number);
  pass_chunk(bytes, chunk);
  return bytes.bytes + sha256(bytes.bytes);
}

/// Throws Error(input) for what isn't this chunk, whole.
TableChunk unpacked(std::string_view text, const std::string& key, std::uint32_t number) {
  constexpr std::size_t digest_size = 64;
  Unpacking bytes{text.substr(0, text.size() - std::min(text.size(), digest_size))};
  const auto fail = [](const char* why) {
    throw Error(ErrorCode::input, std::string("pirsim reference table ") + why);
  };
  if (sha256(bytes.bytes) != text.substr(bytes.bytes.size())) fail("is damaged: its digest differs");
  std::string found_key;
  std::uint32_t found_number = 0;
  pass_text(bytes, found_key);
  if (found_key != key) fail("is of other inputs or settings");
  pass_as<std::uint32_t>(bytes, found_number);
  if (found_number != number) fail("is of other realizations");
  TableChunk chunk;
  pass_chunk(bytes, chunk);
  return chunk;
}

/// What the script has is not looked for a second time: two of a kind on one sensor are refused. Nor is what means
/// nothing to any sensor.
void keep_meaningful(const RealizationSource& source, std::vector<std::string>& hypotheses) {
  std::erase_if(hypotheses, [&](const std::string& hypothesis) {
    return std::ranges::find(source.script.effects, hypothesis, &EffectSpec::name) != source.script.effects.end() ||
           !effects::means_anything(effects::find(hypothesis).info, source.scene, source.script.sensing);
  });
}

}  // namespace

std::vector<Series> pilot_runs(const RealizationSource& source, const StudyFrame& frame, std::uint32_t n_realizations,
                               const Context& context) {
  std::vector<Series> all;
  const auto runs_of = [&](std::size_t i) {
    return SimulatedRealization(source, frame, first_pilot_realization + static_cast<std::uint32_t>(i), 1).plain(0, 1);
  };
  for (auto& runs : in_parallel<std::vector<Series>>(n_realizations, context.threads, runs_of))
    std::ranges::move(runs, std::back_inserter(all));
  return all;
}

std::vector<std::vector<Series>> surroundings_pilot(const RealizationSource& source, const StudyFrame& frame,
                                                    int n_replicates, std::uint32_t n_realizations,
                                                    const Context& context) {
  TableSettings settings{n_realizations, n_realizations, n_realizations, {}};
  for (const effects::Effect* effect : effects::catalogue_for(source.script)) {
    if (effect->info.family == effects::Family::environment) settings.effects.push_back(effect->info.name);
  }
  keep_meaningful(source, settings.effects);
  std::vector<std::vector<Series>> all;
  const auto chunk_of = [&](std::size_t i) {
    return simulate_datasets(source, frame, n_replicates, settings, static_cast<std::uint32_t>(i));
  };
  for (TableChunk& chunk : in_parallel<TableChunk>(n_realizations, context.threads, chunk_of)) {
    for (SimulatedDataset& dataset : chunk.datasets) all.push_back(std::move(dataset.runs));
  }
  return all;
}

ReferenceTable make_reference_table(const RealizationSource& source, const StudyFrame& frame, const DataShape& shape,
                                    const Profile& profile, const TableSettings& asked,
                                    const std::filesystem::path& folder, const Context& context) {
  TableSettings settings = asked;
  if (settings.effects.empty()) {
    for (const effects::Effect* effect : effects::catalogue_for(source.script)) {
      if (effect->info.same_as.empty()) settings.effects.push_back(effect->info.name);
    }
  }
  keep_meaningful(source, settings.effects);
  if (settings.effects.empty())
    throw Error(ErrorCode::usage, "nothing is left to be looked for: the script has every effect that is asked for");
  ReferenceTable table;
  table.key = table_key(source, frame, shape.n_replicates, settings);
  TableStore store(folder, table.key);
  table.effects = settings.effects;
  table.profile = profile;
  for_each_chunk(
      store, settings.n_realizations, context,
      [&](std::uint32_t index) { return simulate_datasets(source, frame, shape.n_replicates, settings, index); },
      [&](TableChunk& chunk) {
        const auto row_of = [&](std::size_t i) { return statistics_of(frame, shape, profile, chunk.datasets[i].runs); };
        for (const auto& row : in_parallel<std::vector<float>>(chunk.datasets.size(), context.threads, row_of))
          table.statistics.append_row(row);
        for (SimulatedDataset& dataset : chunk.datasets) table.rows.push_back(std::move(dataset.row));
        table.n_left_out += chunk.n_left_out;
      });
  return table;
}

std::string table_key(const RealizationSource& source, const StudyFrame& frame, int n_replicates,
                      const TableSettings& settings) {
  Fingerprint print;
  print.add_each(version(), git_revision(), source.scene);
  ScriptSpec script = source.script;
  script.seed = 0;  // realizations have seeds of their own
  script.replicates = 1;
  print.add_each(script, source.nuisance, source.seed, n_replicates, n_statistics(frame));
  add(print, settings);
  add(print, frame);
  return print.digest();
}

TableStore::TableStore(std::filesystem::path folder, const std::string& key) : folder_(std::move(folder)), key_(key) {
  if (!folder_.empty()) take(io::Journal::read(journal_path()));
}

std::filesystem::path TableStore::journal_path() const { return folder_ / "table.journal"; }

void TableStore::take(const std::optional<io::Journal::Content>& journal) {
  if (journal && journal->made_from != key_) {
    throw Error(ErrorCode::input, {journal_path().string(), 0, 0},
                "this folder holds simulated datasets of other inputs, settings (seed, effects, numbers of datasets or "
                "runs, nuisance) or of another build: remove it or name another folder with --table");
  }
  if (!journal && std::filesystem::exists(file(0))) {
    throw Error(ErrorCode::input, {folder_.string(), 0, 0},
                "this folder holds simulated datasets without table.journal, as pirsim 0.1.0 wrote them: remove it or "
                "name another folder with --table");
  }
  there_.clear();
  if (journal) there_.insert(journal->pieces.begin(), journal->pieces.end());
}

void TableStore::claim() {
  if (folder_.empty() || journal_) return;
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);  // opening the journal says why it can't be
  journal_.emplace(journal_path());
  const auto found = io::Journal::read(journal_path());  // another process may have come first
  take(found);
  found ? journal_->resume(*found) : journal_->begin(key_);
}

std::filesystem::path TableStore::file(std::uint32_t number) const {
  const std::string digits = std::to_string(number);
  return folder_ / ("realizations_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".bin");
}

std::optional<TableChunk> TableStore::find(std::uint32_t number) const {
  if (!there_.contains(file(number).filename()) || !std::filesystem::exists(file(number))) return std::nullopt;
  try {
    return unpacked(io::read_text_file(file(number), std::numeric_limits<std::size_t>::max()), key_, number);
  } catch (const Error& error) {
    throw Error(ErrorCode::input, {file(number).string(), 0, 0},
                error.issues().front().message + "; remove this file, and only its realizations are simulated again");
  }
}

void TableStore::keep(std::uint32_t number, const TableChunk& chunk) {
  if (folder_.empty()) return;
  claim();
  io::write_text_file(file(number), packed(chunk, key_, number));
  const std::string name = file(number).filename();
  if (there_.insert(name).second) journal_->add(name);
}

void for_each_chunk(TableStore& store, std::uint32_t n_items, const Context& context, const ItemJob& job,
                    const std::function<void(TableChunk&)>& use) {
  const auto tell = [&](std::uint32_t n_there) {
    if (context.observer.progress) context.observer.progress(n_there, n_items);
  };
  tell(0);
  for (std::uint32_t first = 0; first < n_items; first += items_per_chunk) {
    const std::uint32_t n = std::min(items_per_chunk, n_items - first);
    std::optional<TableChunk> chunk = store.find(first / items_per_chunk);
    if (!chunk) {
      store.claim();
      chunk = store.find(first / items_per_chunk);
    }
    if (chunk) {
      tell(first + n);
    } else {
      std::uint32_t n_there = first;
      chunk.emplace();
      ordered_parallel<TableChunk>(
          n, context.threads, [&](std::size_t i) { return job(first + static_cast<std::uint32_t>(i)); },
          [&](TableChunk& one) {
            chunk->n_left_out += one.n_left_out;
            std::ranges::move(one.datasets, std::back_inserter(chunk->datasets));
            tell(++n_there);
          });
      store.keep(first / items_per_chunk, *chunk);
    }
    use(*chunk);
  }
}

}  // namespace pirsim::reconcile
