// Counter-based random streams (Philox4x32-10, Random123).
// Ref: [Salmon2011]. A stream is a pure function of its key, so results depend neither on the order in which
// streams are used nor on threads or shards, and switching one stream on never reshuffles another.
#pragma once

#include <array>
#include <cstdint>

namespace pirsim {

/// What a stream is used for. Append only: a value is part of every published result.
enum class Purpose : std::uint32_t {
  spine_tilt = 1,           ///< which tilt a sitter takes at each redraw
  seat_scatter = 2,         ///< where exactly, and how turned, a sitter sits down in this run
  zone_edge = 3,            ///< soft_zone_edges: which of the nested zones decides in a window
  false_trigger = 4,        ///< false_triggers: when the next one comes
  burst = 5,                ///< trigger_bursts: when the first burst comes in a run, and its triggers
  warm_chair = 6,           ///< warm_chair: triggers after a seat was left
  missed_trigger = 7,       ///< missed_triggers: which windows are lost
  pulse_length = 8,         ///< pulse_stretching: how long an output holds
  fidgeting = 9,            ///< fidgeting: when somebody moves, and how
  dead_sensor = 10,         ///< dead_sensor: which rows a dying sensor loses
  natural_motion = 12,      ///< small movements of a person of natural style, and how lively they are
  pace = 13,                ///< how fast such a person walks in a run
  conversation = 14,        ///< who speaks in a meeting, and for how long
  schedule = 15,            ///< when one person of a schedule comes, what they do and when they go
  schedule_meetings = 16,   ///< when meetings are held, and who comes
  schedule_body = 17,       ///< how large the people of a schedule are
  schedule_conduct = 18,    ///< whom one of them visits, where they stand, what they do at their desk
  chair_swing = 19,         ///< chair_swing: in which bouts somebody swings on the chair
  trunk_sway = 20,          ///< trunk_sway: in which bouts somebody sways
  uneven_arms = 21,         ///< uneven_arms: each swing's amplitude and period
  rough_surface = 22,       ///< wall_reflection: where each ray goes on
  swept_area = 23,          ///< soft_zone_edges: whether what swept a zone is noticed
  occupancy = 24,           ///< who comes or goes between two readings of a count, when, and where to
  occupancy_conduct = 25,   ///< what somebody does at a seat that a count gave them, and by which doors they go
  home_day = 26,            ///< when a resident gets up, what they do and how long
  home_meals = 27,          ///< when a household eats, who cooks, when a visitor comes
  day_liveliness = 29,      ///< how lively everybody is in a run
  door_habit = 28,          ///< after which passes a door is shut at once
  pet = 34,                 ///< when a pet roams, where to and where it rests
  schedule_warmth = 31,     ///< clothes, sleeves, hair and skin of the people of a schedule
  home_errands = 32,        ///< what a resident gets up for, where they go at home and how long they stop there
  home_restlessness = 33,   ///< how much longer than others a resident stays seated; the same on all days
  telegram_collision = 43,  ///< telegram_collisions: which windows' telegrams collide, and which survives
  array_frame = 41,         ///< noise of one frame of a thermopile array; entity: frame
  array_unit = 42,          ///< what one thermopile array always adds; the same in all runs
  effect_prior = 11,        ///< parameters drawn from the catalogue's priors
  // Of statistics, from 100 on.
  tied_ranks = 100,    ///< order of equal values in a rank test
  tree_growing = 102,  ///< columns and thresholds that a randomised tree tries
  projection = 103,    ///< random directions that a subspace is found from
  // Of reconciliation, from 200 on.
  nuisance = 200,              ///< where seats and sensors really are, and how large people are
  simulated_seed = 201,        ///< seeds of simulated datasets
  reference_parameters = 202,  ///< parameters of effects, from their priors
  analysis = 203,              ///< ties, forests, splits
  injected_effects = 204,      ///< what a self-test hides
  model_check = 205,           ///< parameters of a fitted effect in the realizations that its model is checked in
  // Of the physical response, from 300 on.
  detector_noise = 300,  ///< of one sensor's element and amplifier
  reader_phase = 301,    ///< when in its window each sensor is read
  sensor_unit = 302,     ///< how sensitive one sensor is among those of its room; the same in all runs
  installation = 303,    ///< how sensitive all sensors of a room are; the same in all runs
  // Of datasets, from 400 on.
  room = 400,            ///< size, furniture and sensors of a parametric room; entity: which try
  room_people = 401,     ///< how many people a room has, and of which role
  room_effects = 402,    ///< effects and their parameters that belong to a room
  day_effects = 403,     ///< the same of one of its days
  dataset_part = 404,    ///< which rooms and days are for training, validation and test
  dataset_seed = 405,    ///< seeds of the studies that a dataset is made of
  weighted_rooms = 406,  ///< where drawing rooms by weight begins
  flat = 407,            ///< rooms, furniture and sensors of a parametric flat; entity: which try
  flat_household = 408,  ///< how many people live in a flat, what they do, how old they are, their habits
  room_ambient = 409,    ///< how warm a room is
  day_ambient = 410,     ///< how much warmer one of its days
  home_pets = 411,       ///< which pets a home has
  // Of light, from 500 on.
  drawn_days = 500,    ///< days drawn with replacement, for intervals over days
  drawn_people = 501,  ///< who may have been there, by a counter; run: which draw
  test = 0xFFFF0000,   ///< reserved for tests
};

struct StreamKey {
  std::uint64_t seed = 0;    ///< of the whole study
  std::uint32_t run = 0;     ///< index of the run in the study
  std::uint32_t entity = 0;  ///< index of the person or sensor that draws
  Purpose purpose = Purpose::test;
  bool operator==(const StreamKey&) const = default;
};

/// A value: copying it copies the position in the stream. Distributions are our own because those of <random>
/// differ between standard libraries.
class Stream {
 public:
  explicit Stream(StreamKey key) noexcept : key_(key) {}
  [[nodiscard]] std::uint32_t next_u32() noexcept;
  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform() noexcept;
  /// Uniform in {0, ..., n - 1}, without modulo bias; n >= 1.
  [[nodiscard]] std::uint32_t index(std::uint32_t n) noexcept;
  /// Standard normal (Box-Muller, one value per call, the pair's second discarded: no hidden state).
  [[nodiscard]] double normal() noexcept;
  bool operator==(const Stream&) const = default;

 private:
  StreamKey key_;
  std::uint32_t block_ = 0;  ///< index of the next Philox block of four words
  std::uint32_t used_ = 4;   ///< words of the current block already given out
  std::array<std::uint32_t, 4> words_{};
};

}  // namespace pirsim
