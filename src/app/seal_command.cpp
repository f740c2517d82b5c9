#include <iomanip>
#include <iostream>
#include <optional>
#include <random>
#include <sstream>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/io.hpp"
#include "reconcile/report/sentences.hpp"
#include "reconcile/validation/seal.hpp"

namespace pirsim::app {
namespace {

namespace fs = std::filesystem;

struct SealOptions {
  fs::path output = "challenge";  ///< folder of what may be published
  fs::path answer;                ///< what must be kept secret
  fs::path nuisance;              ///< file, "none", or empty: the usual
  reconcile::Hidden hidden = reconcile::Hidden::any;
  int runs = 1;
  std::optional<std::uint64_t> secret_seed;
};

struct OpenOptions {
  fs::path answer, commitment, report;
};

constexpr std::size_t digest_digits = 64;

/// What nobody can foresee: from the system, unless the user gives a secret of their own.
std::uint64_t secret_word() {
  std::random_device source;
  return (static_cast<std::uint64_t>(source()) << 32U) | source();
}

std::string new_salt() {
  std::ostringstream text;
  text << std::hex << std::setfill('0') << std::setw(16) << secret_word() << std::setw(16) << secret_word();
  return text.str();
}

struct ChallengeFiles {
  fs::path answer, folder, rows, commitment;
};

/// What was committed to must not be lost, and the answer not be handed over with the data.
void check_files(const ChallengeFiles& files) {
  std::error_code unknown;
  for (const fs::path& file : {files.answer, files.rows, files.commitment}) {
    if (fs::exists(file, unknown))
      throw Error(ErrorCode::usage, "'" + file.string() + "' is there already and isn't overwritten");
  }
  if (is_below(files.answer, files.folder))
    throw Error(ErrorCode::usage, "--answer: the answer is secret, and --out is the folder that is handed over");
}

/// All or none: an answer without its data would be in the way of the next try.
void write(const ChallengeFiles& files, const reconcile::Challenge& challenge) {
  try {
    io::write_text_file(files.answer, challenge.answer);
    std::error_code fault;
    fs::create_directories(files.folder, fault);
    if (fault) throw Error(ErrorCode::io, Where{files.folder.string()}, "can't make the folder: " + fault.message());
    io::write_text_file(files.rows, challenge.rows);
    // as sha256sum -c reads it
    io::write_text_file(files.commitment, challenge.commitment + "  " + files.answer.filename().string() + '\n');
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& file : {files.answer, files.rows, files.commitment}) fs::remove(file, ignored);
    throw;
  }
}

reconcile::Document read_document(const fs::path& file) { return {file.string(), io::read_text_file(file)}; }

void seal_challenge(const Inputs& inputs, const SealOptions& options) {
  if (options.answer.empty())
    throw Error(ErrorCode::usage, "--answer FILE is missing; see pirsim reconcile seal --help");
  const fs::path& folder = options.output;
  const ChallengeFiles files{options.answer, folder, folder / "measured.csv", folder / "commitment.sha256"};
  check_files(files);
  const ScriptSpec script = read_script(inputs);
  const SceneSpec scene = read_scene(inputs);
  tell(scene.warnings, inputs.verbosity);
  tell(script.warnings, inputs.verbosity);
  reconcile::SealSettings settings;
  settings.nuisance = nuisance_of(options.nuisance);
  settings.hidden = options.hidden;
  settings.n_replicates = options.runs;
  settings.secret_seed = options.secret_seed ? *options.secret_seed : secret_word();
  settings.salt = new_salt();
  const reconcile::Challenge challenge = reconcile::seal(scene, script, settings);
  write(files, challenge);
  std::cout << challenge.commitment << '\n';
  require_written();
  tell_written({{files.answer}, {files.rows}, {files.commitment}}, inputs.verbosity);
}

void open_challenge(const OpenOptions& options) {
  const std::string published = io::read_text_file(options.commitment).substr(0, digest_digits);
  if (published.size() != digest_digits || published.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw Error(ErrorCode::input, {options.commitment.string(), 1, 1}, "expected a SHA-256 of 64 hexadecimal digits");
  const reconcile::Score score =
      reconcile::open_answer(read_document(options.answer), published, read_document(options.report));
  std::cout << reconcile::sentence(score) << '\n';
  require_written();
}

}  // namespace

void add_seal_command(CLI::App& reconcile_command) {
  CLI::App& command = add_command(reconcile_command, "seal", "hide something in data, to be found blindly", R"(
  pirsim reconcile seal --scene room.gltf --script study.yaml -o challenge --answer secret/answer.json
  pirsim reconcile seal --scene room.gltf --script study.yaml --hide one --runs 3 --answer secret/answer.json
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<SealOptions>();
  offer_study(command, *inputs);
  using reconcile::Hidden;
  offer_output_folder(command, "-o,--out", options->output, "folder for data and hash (default: challenge)",
                      {"measured.csv", "commitment.sha256"});
  offer_output(command, "--answer", options->answer, "where the sealed answer goes, JSON; keep it secret");
  offer_input_file(command, "--nuisance", options->nuisance, "what is uncertain about the room, YAML; or none");
  command.add_option("--hide", options->hidden, "any, nothing, one, two or out-of-catalogue (default: any)")
      ->option_text("KIND")
      ->transform(one_of<Hidden>({{"any", Hidden::any},
                                  {"nothing", Hidden::nothing},
                                  {"one", Hidden::one},
                                  {"two", Hidden::two},
                                  {"out-of-catalogue", Hidden::out_of_catalogue}}));
  command.add_option("--runs", options->runs, "runs of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
  command.add_option("--secret-seed", options->secret_seed, "of everything drawn (default: from the system)")
      ->option_text("N")
      ->check(is_seed());
  on_call(command, inputs, [options](const Inputs& given) { seal_challenge(given, *options); });
}

void add_open_command(CLI::App& reconcile_command) {
  CLI::App& command = add_command(reconcile_command, "open", "score a report against the sealed answer", R"(
  pirsim reconcile open --answer secret/answer.json --commitment challenge/commitment.sha256 --report found/report.json
)");
  const auto options = std::make_shared<OpenOptions>();
  offer_input_file(command, "--answer", options->answer, "the sealed answer")->required();
  offer_input_file(command, "--commitment", options->commitment, "the published hash")->required();
  offer_input_file(command, "--report", options->report, "report.json to be scored")->required();
  command.callback([options] { open_challenge(*options); });
}

}  // namespace pirsim::app
