// What happens in a study as plain data: people and their actions, the trials, how sensors are read.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/input_file.hpp"
#include "pirsim/occupancy.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/sensor.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim {

/// An entry of `effects:`; names are those of the catalogue (pirsim/effects.hpp), which checks them when a
/// Model is compiled.
struct EffectSpec {
  std::string name;
  std::map<std::string, double, std::less<>> parameters;  ///< by name with unit; missing: the catalogue's typical value
  std::map<std::string, std::string, std::less<>> choices;  ///< `sensor: PIR3`; missing: all, or the effect's own way
  Where where;                                              ///< for messages
};

enum class ChangePer { cluster, beam };  ///< whose change of activity is motion
enum class RaysPerZone { one = 1, five = 5, nine = 9, sixteen = 16 };

/// When in a window each sensor is asked whether it has triggered since it was last asked.
enum class Reader {
  in_step,      ///< all at the window's end: a row tells its own window
  free_running  ///< each at a moment of its own, drawn once a run: as hardware that isn't in step with the rows
};

/// How sensitive each sensor is among those of its make (SensitivitySpec).
enum class Units {
  typical,     ///< the median
  low,         ///< nine in ten are more sensitive: for who plans
  guaranteed,  ///< as rated
  drawn        ///< one installation, and each of its sensors its own, the same in all runs
};

struct SensingSpec {
  int tick_rate_hz = 50;
  int ticks_per_window = 50;  ///< a row and its bits cover this many ticks
  RaysPerZone rays_per_zone = RaysPerZone::five;
  ChangePer change_per = ChangePer::cluster;
  Reader reader = Reader::in_step;
  std::optional<Response> response;  ///< of all sensors but beams; otherwise each its own
  Units units = Units::typical;      ///< in the physical response
  /// Of surfaces and of the air, where the scene says nothing else: offices' mean. Ref: [Foldvary2018].
  double ambient_c = 23.0;
  /// Rays of a zone in the physical response (docs/physics/analog.md has the convergence).
  int analog_rays_per_zone = 34;
  std::optional<double> frame_rate_hz;  ///< of all thermopile arrays; otherwise each its own
};

/// Which cells a summary adds up, and what they are compared with.
struct SummarySpec {
  std::vector<std::string> phases;  ///< rows in these phases count
  std::string reference_file;       ///< CSV with measured sums, or empty; beside the script, or shipped
  Where where;
};

/// Person-to-person and chair-to-chair variation, drawn once a run and person.
struct SeatScatterSpec {
  double position_sd_m = 0.0;  ///< of each horizontal coordinate
  double heading_sd_deg = 0.0;
};

/// What people of natural style are busy with, beside their choreography.
enum class Activity { typing, reading, meeting, phone, whiteboard, sleeping, watching_tv, cooking, washing, eating };
inline constexpr std::array<const char*, 10> activity_names{
    "typing", "reading", "meeting", "phone", "whiteboard", "sleeping", "watching_tv", "cooking", "washing", "eating"};

enum class LyingPosture { back, left_side, right_side, half_lying };  ///< half_lying: on the back, the trunk raised

// Actions, carried out one after the other. Names are resolved against the scene when a Model is compiled.
namespace action {
struct Wait {
  double duration_s = 0.0;
  std::optional<Activity> activity{};  ///< of natural style, as in other actions
};
/// Is there from now on, without having entered: stands on the floor, or is at a place as its posture says.
struct Appear {
  Vec2 point{0.0};
  double heading_deg = 0.0;                   ///< 0 facing -Z, positive turning left
  std::string place{};                        ///< or seat, instead of a point; empty: at the point
  LyingPosture posture = LyingPosture::back;  ///< at a place to lie
};
/// Appears outside the entrance and walks to just inside it, or straight on if the next action leads elsewhere.
struct Enter {
  std::string entrance;
};
/// Walks to each of the given floor points in turn.
struct Walk {
  std::vector<Vec2> points;
  std::optional<Activity> activity{};
};
/// What somebody does whose seat stays taken.
enum class IfTaken { next_action, other_seat };
/// Walks to the seat, turns and sits down. Waits for a seat that somebody else has, for a while.
struct Sit {
  std::string seat;
  double wait_s = 120.0;  ///< assumed (tried 0 to 600); no longer if all others have carried out their scripts
  IfTaken if_taken = IfTaken::next_action;
};
/// Walks to the place, sits down on its edge and swings the legs in. Waits for it as for a seat.
struct Lie {
  std::string place;
  LyingPosture posture = LyingPosture::back;
  double wait_s = 120.0;  ///< assumed, as of seats
};
/// Walks to the place and faces as it does. Waits for it as for a seat.
struct Stand {
  std::string place;
  double wait_s = 120.0;  ///< assumed, as of seats
};
/// Desk work while seated: both forearms slide on the table in opposite phase, the spine changes its tilt.
struct Work {
  double duration_s = 180.0;
  double arm_amplitude_m = 0.1;  ///< paper: 0.1 sin(2 pi t / 3)
  double arm_period_s = 3.0;
  std::vector<double> tilt_choices_deg{-15.0, 0.0, 15.0};  ///< positive forward
  double tilt_every_s = 30.0;
  std::optional<Activity> activity{};  ///< of natural style, which has no use for swing and tilts; none: typing
};
/// Rises from the seat, or from where one lies, and stays standing beside it.
struct Rise {};
/// Walks out through the entrance (rising first if seated) and disappears.
struct Leave {
  std::string entrance;
};
/// Stands on the spot and turns to face a heading.
struct Turn {
  double heading_deg = 0.0;
};
/// Is at these points at these times, and straight between them, whatever is in the way: comes into being at the first
/// and vanishes after the last.
struct Follow {
  std::vector<double> times_s;  ///< of the run, ascending
  std::vector<Vec2> points;
  std::vector<double> headings_deg;  ///< at each point, or none: facing where they go
};
}  // namespace action

using Action = std::variant<action::Wait, action::Appear, action::Enter, action::Walk, action::Sit, action::Work,
                            action::Rise, action::Leave, action::Turn, action::Follow, action::Lie, action::Stand>;

struct ScriptedAction {
  Action what;
  std::optional<double> at_s{};  ///< starts then: interrupts what goes on, or waits if that is already done
  std::string phase{};           ///< label of rows while this action runs; empty: what the body is doing
  Where where{};                 ///< for messages
};

/// Meshes by the name of the body part (model/schema/words.hpp) that they stand for, in that part's frame.
using BodyMeshes = std::map<std::string, MeshSolid, std::less<>>;

/// How warm a person's surface is, for the physical response. Derivation: docs/physics/analog.md. Hands are bare.
struct WarmthSpec {
  std::optional<double> skin_c;  ///< none: as the air's temperature has it
  double skin_above_k = 0.0;     ///< by how much this person's skin is then warmer than others'
  /// Insulation of the whole outfit, clo: 0.5 light summer clothes, 0.61 trousers and a shirt with long sleeves, 1 a
  /// suit. Ref: [ASHRAE55].
  double clothing_clo = 0.61;
  std::vector<std::string> bare{"head"};  ///< parts that show skin: forearms, too, in short sleeves
  double hair_share = 0.5;                ///< of a bare head's surface; what hair covers is cooler than skin
  std::map<std::string, double> parts_c;  ///< surface temperatures that are known, by part
};

/// A person; lengths follow from stature by the fractions of Drillis & Contini (1966).
struct PersonSpec {
  std::string id;
  double stature_m = 1.86;
  double mass_kg = 80.0;
  double walking_speed_m_s = 1.0;
  SeatScatterSpec seat_scatter;
  std::string body_mesh_file;  ///< glTF, or empty; relative to the script
  BodyMeshes body_meshes;      ///< what was read from it: parts without a mesh stay primitive solids
  WarmthSpec warmth;
  MotionStyle style = MotionStyle::choreographed;
  std::vector<ScriptedAction> actions;
};

enum class PetKind { cat, dog };

/// An animal of the household or the office: rests, roams in bouts, gets onto furniture if it is a cat. Nobody counts
/// it, and it opens no doors. Sizes that are left out are the kind's usual ones (docs/physics/pets.md).
struct PetSpec {
  std::string id;
  PetKind kind = PetKind::cat;
  std::optional<double> height_m;  ///< of the back, standing
  std::optional<double> length_m;  ///< nose to rump
  std::optional<double> mass_kg;
  Where where;
};

/// One choreography; a study runs every trial once per replicate.
struct TrialSpec {
  std::string id;                            ///< as the output names it, "S1"
  std::vector<PersonSpec> people;            ///< the first one's actions name the rows' phase
  std::optional<double> duration_s{};        ///< of a run; none: until all subjects have carried out all actions
  std::optional<ScheduleSpec> schedule{};    ///< adds people whose actions are drawn anew for every run
  std::optional<OccupancySpec> occupancy{};  ///< adds people who are there as data say
  std::vector<PetSpec> pets{};               ///< move by themselves
};

struct ScriptSpec {
  std::string name;
  std::uint64_t seed = 1;
  int replicates = 1;
  /// Local date and time at which every run begins, "2026-03-02T07:00"; empty: runs have no clock, or the schedule's,
  /// or that of the occupancy's data.
  std::string begin;
  SensingSpec sensing;
  SummarySpec summary;
  std::vector<TrialSpec> trials;
  std::vector<EffectSpec> effects;  ///< what the plain model leaves out; applied when a Model is compiled
  std::vector<Issue> warnings;
  std::string directory;         ///< of the script file, for relative references
  std::vector<InputFile> files;  ///< all that was read: script, body meshes and their buffers
};

/// Refuses what the reader of files would refuse, each fault with its field: `script.trials[0].people[1].stature_m:
/// expected ...`. compile() does so.
void check(const ScriptSpec& script, Diagnostics& diagnostics);

/// What nobody knows exactly about a real room and its people: drawn anew for every simulated dataset of a
/// reconciliation, never fitted.
/// Half-widths of uniform distributions round the value that scene or script gives. Shared by a whole dataset, since it
/// is one real room with one real person: sensors and bodies are drawn once, seats once each.
struct NuisanceSpec {
  double seat_position_m = 0.04;  ///< of each horizontal coordinate of a seat; assumed (tried 0-0.08)
  double sensor_yaw_deg = 1.5;    ///< of each sensor; assumed (tried 0-3)
  double sensor_tilt_deg = 1.0;   ///< assumed (tried 0-2)
  double body_size = 0.03;        ///< of stature, relative; mass follows with its cube; assumed (tried 0-0.06)
  double arm_amplitude = 0.10;    ///< of desk work, relative; assumed (tried 0-0.2)
  /// Upper ends of uniform distributions from 0 on, of effects that everybody at work then has. Off unless asked for:
  /// somebody who works by the metronome, as in Study A, has none of it.
  double uneven_arms = 0.0;     ///< spread of `uneven_arms`; people at their own work: assumed 0.2
  double trunk_sway_deg = 0.0;  ///< amplitude of `trunk_sway`; people at their own work: assumed 1
  // Of sensors with the analog response alone.
  double sensor_gain = 0.1;  ///< of each, relative; a threshold off by as much looks the same; assumed (tried 0-0.2)
  double ambient_c = 1.0;    ///< of the room's temperature; assumed (tried 0-2)
  // Of an occupancy's counts, which nothing else uses.
  double time_s = 60.0;    ///< of each coming and going: a diary is right to about a minute; assumed (tried 0-120)
  double own_seats = 1.0;  ///< most share of the seats that aren't needed which nobody takes; assumed (tried 0-1)
  bool operator==(const NuisanceSpec&) const = default;
};

struct SceneSpec;
/// Of a script's `occupancy: positions`, a warning a file: nobody is ever over the floor, steps that nobody can take, a
/// walk that is hardly a walk, everybody in a small part of the floor; with what the numbers look like, if one unit or
/// axis makes more of them.
[[nodiscard]] std::vector<Issue> doubts_of_positions(const SceneSpec& scene, const ScriptSpec& script);

}  // namespace pirsim
