// Fields of places in files, and of messages about them (schema/fields.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <tuple>

#include "model/schema/field.hpp"
#include "model/schema/words.hpp"
#include "pirsim/error.hpp"
#include "pirsim/input_file.hpp"
#include "pirsim/occupancy.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

template <>
struct Fields<Where> {
  using S = Where;
  static constexpr const char* name = "Where";
  static constexpr const char* about = "A place in a file, for messages; line and column count from 1.";
  static constexpr std::tuple all{LABEL(file), LABEL(line), LABEL(column)};
};

template <>
struct Fields<InputFile> {
  using S = InputFile;
  static constexpr const char* name = "InputFile";
  static constexpr const char* about = "A file that was read, and the SHA-256 of the bytes that it had then.";
  static constexpr std::tuple all{LABEL(path), LABEL(sha256)};
};

template <>
struct Fields<Issue> {
  using S = Issue;
  static constexpr const char* name = "Diagnostic";
  static constexpr const char* about = "One fault or remark.";
  static constexpr std::tuple all{LABEL(severity), LABEL(where), LABEL(message)};
};

// Fields of people in scripts, and of what they do (schema/fields.hpp).

template <>
struct Fields<action::Wait> {
  using S = action::Wait;
  static constexpr const char* name = "Wait";
  static constexpr const char* about = "Goes on standing, sitting or lying.";
  static constexpr std::tuple all{
      FIELD(duration_s, accepted::waited_s),
      FIELD(activity,
            std::array{Activity::meeting, Activity::phone, Activity::whiteboard, Activity::reading, Activity::sleeping,
                       Activity::watching_tv, Activity::cooking, Activity::washing, Activity::eating},
            "of natural style")};
};
template <>
struct Fields<action::Appear> {
  using S = action::Appear;
  static constexpr const char* name = "Appear";
  static constexpr const char* about =
      "Is there from now on, without having entered: stands at the point, or is at the place as its posture says.";
  static constexpr std::tuple all{FIELD(point), FIELD(heading_deg, NumberRange{}, "0 facing -Z, positive turning left"),
                                  FIELD(place, "or seat, instead of a point"), FIELD(posture, "at a place to lie")};
};
template <>
struct Fields<action::Enter> {
  using S = action::Enter;
  static constexpr const char* name = "Enter";
  static constexpr const char* about = "Appears outside the entrance and walks in.";
  static constexpr std::tuple all{FIELD(entrance)};
};
template <>
struct Fields<action::Walk> {
  using S = action::Walk;
  static constexpr const char* name = "Walk";
  static constexpr const char* about = "Walks to each of the floor points in turn.";
  static constexpr std::tuple all{FIELD(points), FIELD(activity, std::array{Activity::phone}, "of natural style")};
};
template <>
struct Fields<action::Sit> {
  using S = action::Sit;
  static constexpr const char* name = "Sit";
  static constexpr const char* about =
      "Walks to the seat, turns and sits down; waits for it for a while if somebody else has it.";
  static constexpr std::tuple all{
      FIELD(seat),
      FIELD(wait_s, accepted::waited_s, "for a taken seat; no longer if all others have carried out their scripts"),
      FIELD(if_taken, "what somebody does whose seat stays taken")};
};
template <>
struct Fields<action::Lie> {
  using S = action::Lie;
  static constexpr const char* name = "Lie";
  static constexpr const char* about = "Walks to a place to lie, sits down on its edge and swings the legs in.";
  static constexpr std::tuple all{FIELD(place), FIELD(posture), FIELD(wait_s, accepted::waited_s, "for a taken place")};
};
template <>
struct Fields<action::Stand> {
  using S = action::Stand;
  static constexpr const char* name = "Stand";
  static constexpr const char* about = "Walks to a place to stand at, and faces as it does.";
  static constexpr std::tuple all{FIELD(place), FIELD(wait_s, accepted::waited_s, "for a taken place")};
};
template <>
struct Fields<action::Work> {
  using S = action::Work;
  static constexpr const char* name = "Work";
  static constexpr const char* about =
      "Desk work while seated: both forearms slide on the table, the spine changes its tilt.";
  static constexpr std::tuple all{
      FIELD(duration_s, accepted::worked_s),
      FIELD(arm_amplitude_m, NumberRange{.min = 0.0, .max = 0.15}),
      FIELD(arm_period_s, NumberRange{.min = 0.2, .max = 1e6}),
      FIELD(tilt_choices_deg, NumberRange{.min = -30.0, .max = 45.0}, "positive forward"),
      FIELD(tilt_every_s, accepted::worked_s),
      FIELD(activity, std::array{Activity::typing, Activity::reading, Activity::meeting, Activity::phone},
            "of natural style, which has no use for the swing and the tilts; none: typing")};
};
template <>
struct Fields<action::Rise> {
  using S = action::Rise;
  static constexpr const char* name = "Rise";
  static constexpr const char* about = "Rises from where one sits or lies, and stays standing beside it.";
  static constexpr std::tuple<> all{};
};
template <>
struct Fields<action::Leave> {
  using S = action::Leave;
  static constexpr const char* name = "Leave";
  static constexpr const char* about = "Walks out through the entrance and disappears.";
  static constexpr std::tuple all{FIELD(entrance)};
};
template <>
struct Fields<action::Turn> {
  using S = action::Turn;
  static constexpr const char* name = "Turn";
  static constexpr const char* about = "Stands on the spot and turns.";
  static constexpr std::tuple all{FIELD(heading_deg, accepted::turned_deg, "0 facing -Z, positive turning left")};
};
template <>
struct Fields<action::Follow> {
  using S = action::Follow;
  static constexpr const char* name = "Follow";
  static constexpr const char* about =
      "Is at these points at these times, and straight between them: appears at the first, vanishes after the last.";
  static constexpr std::tuple all{FIELD(times_s, "of the run, ascending"), FIELD(points),
                                  FIELD(headings_deg, "at each of them, or none: facing where they go")};
};
template <>
struct Fields<ScriptedAction> {
  using S = ScriptedAction;
  static constexpr const char* name = "ScriptedAction";
  static constexpr const char* about = "An action and when it begins.";
  static constexpr std::tuple all{
      FIELD(what),
      FIELD(at_s, accepted::at_s, "starts then: interrupts what goes on, or waits if that is already done"),
      FIELD(phase, "label of rows while this action runs; empty: what the body is doing"), LABEL(where)};
};
template <>
struct Fields<SeatScatterSpec> {
  using S = SeatScatterSpec;
  static constexpr const char* name = "SeatScatter";
  static constexpr const char* about = "How far from the seat's place people sit down, drawn once a run and person.";
  static constexpr std::tuple all{
      FIELD(position_sd_m, NumberRange{.min = 0.0, .max = 0.2}, "of each horizontal coordinate"),
      FIELD(heading_sd_deg, NumberRange{.min = 0.0, .max = 30.0})};
};
template <>
struct Fields<WarmthSpec> {
  using S = WarmthSpec;
  static constexpr const char* name = "Warmth";
  static constexpr const char* about = "How warm a person's surface is, for the physical response.";
  static constexpr std::tuple all{
      FIELD(skin_c, accepted::skin_c, "none: as the air's temperature has it"),
      FIELD(skin_above_k, NumberRange{.min = -10.0, .max = 10.0}, "by how much it is then warmer than others'"),
      FIELD(clothing_clo, NumberRange{.min = 0.0, .max = 10.0}, "insulation of the whole outfit"),
      FIELD(bare, "parts that show skin; hands always do"),
      FIELD(hair_share, NumberRange{.min = 0.0, .max = 1.0}, "of a bare head's surface that hair covers"),
      FIELD(parts_c, "surface temperatures that are known, by part")};
};
template <>
struct Fields<PersonSpec> {
  using S = PersonSpec;
  static constexpr const char* name = "Person";
  static constexpr const char* about = "A person and what they do, one action after the other.";
  static constexpr std::tuple all{
      FIELD(id),
      FIELD(actions),
      FIELD(stature_m, NumberRange{.min = 0.8, .max = 2.3}, "lengths of the body follow from it"),
      FIELD(mass_kg, NumberRange{.min = 10.0, .max = 250.0}),
      FIELD(walking_speed_m_s, NumberRange{.min = 0.1, .max = 3.0}),
      FIELD(seat_scatter),
      FIELD(style),
      FIELD(warmth),
      FIELD(body_mesh_file, "glTF, relative to `Script.directory`; its meshes are read by `read_script()`"),
      FIELD(body_meshes)};
};

// Fields of sensors: optics, zones, electronics (schema/fields.hpp).

template <>
struct Fields<OpticsSpec> {
  using S = OpticsSpec;
  static constexpr const char* name = "Optics";
  static constexpr const char* about = "What the physical response needs of a lens beyond its zones.";
  static constexpr std::tuple all{
      FIELD(blur_deg, NumberRange{.min = 0.0, .max = 10.0},
            "standard deviation of the Gaussian that softens a zone's edges"),
      FIELD(aperture_mm2, NumberRange{.above = 0.0, .max = 1000.0}, "area of a facet of the first lens step")};
};
template <>
struct Fields<ElementSpec> {
  using S = ElementSpec;
  static constexpr const char* name = "Element";
  static constexpr const char* about = "The pyroelectric element's time constants.";
  static constexpr std::tuple all{FIELD(thermal_s, accepted::time_constant_s, "thermal time constant"),
                                  FIELD(electrical_s, accepted::time_constant_s, "electrical time constant")};
};
template <>
struct Fields<AmplifierSpec> {
  using S = AmplifierSpec;
  static constexpr const char* name = "Amplifier";
  static constexpr const char* about = "A band-pass with noise.";
  static constexpr std::tuple all{
      FIELD(low_hz, accepted::corner_hz, "lower corner frequency (-3 dB)"),
      FIELD(high_hz, accepted::corner_hz, "upper corner frequency (-3 dB)"),
      FIELD(order, IntegerRange{.min = 1, .max = 3}, "one-pole sections per edge, 1 to 3"),
      FIELD(volts_per_watt, NumberRange{.above = 0.0},
            "total gain from the power on the element to the output; by default calibrated on the rated distance of "
            "the first lens step"),
      FIELD(noise_v_pp, accepted::output_v, "noise at the output, peak to peak (6.6 standard deviations); 0: none"),
      FIELD(offset_v, accepted::output_v, "output at rest"),
      FIELD(lowest_v, accepted::output_v, "where the output saturates at its lower end"),
      FIELD(highest_v, accepted::output_v, "where the output saturates at its upper end")};
};
template <>
struct Fields<ComparatorSpec> {
  using S = ComparatorSpec;
  static constexpr const char* name = "Comparator";
  static constexpr const char* about = "When the amplified signal switches the output on and off.";
  static constexpr std::tuple all{
      FIELD(positive_v, accepted::threshold_v, "threshold above the offset"),
      FIELD(negative_v, accepted::threshold_v, "threshold below the offset, as a positive number"),
      FIELD(pulse_count, IntegerRange{.min = 1, .max = 8}, "number of pulses that switches the output on, 1 to 8"),
      FIELD(pulse_window_s, accepted::held_s,
            "time within which the pulses must begin; required for more than one pulse"),
      FIELD(pulse_signs, "`alternating`: a pulse counts only on the opposite side to the last")};
};
template <>
struct Fields<ReportSpec> {
  using S = ReportSpec;
  static constexpr const char* name = "Report";
  static constexpr const char* about = "When a device says that there is motion, and for how long.";
  static constexpr std::tuple all{
      FIELD(hold_s, accepted::held_s, "how long it goes on after the last motion that counts"),
      FIELD(again_s, accepted::held_s,
            "how long after motion that counted other motion doesn't; 0: the hold re-triggers"),
      FIELD(blind_s, accepted::held_s, "how long motion is ignored after it has ended")};
};
template <>
struct Fields<DetectorSpec> {
  using S = DetectorSpec;
  static constexpr const char* name = "Detector";
  static constexpr const char* about = "A sensor's electronics, for the physical response.";
  static constexpr std::tuple all{FIELD(element), FIELD(amplifier), FIELD(comparator), FIELD(report)};
};
template <>
struct Fields<ZoneSpec> {
  using S = ZoneSpec;
  static constexpr const char* name = "Zone";
  static constexpr const char* about =
      "A detection zone, drawn on the plane `plane_m` ahead of the sensor: four corners (x right, y up), metres.";
  static constexpr std::tuple all{FIELD(corners, "in order round the zone, convex"),
                                  FIELD(polarity, "+1 or -1, the sign of the element")};
};
template <>
struct Fields<ClusterSpec> {
  using S = ClusterSpec;
  static constexpr const char* name = "Cluster";
  static constexpr const char* about = "The zones of one facet of the lens.";
  static constexpr std::tuple all{
      FIELD(centre, "on the plane"),
      FIELD(range_m, NumberRange{.above = 0.0, .max = 1000.0}, "rated detection distance"),
      FIELD(lens_step, IntegerRange{.min = 1, .max = 99}, "row of the lens: 1 reaches farthest"), FIELD(zones)};
};
template <>
struct Fields<RatedTargetSpec> {
  using S = RatedTargetSpec;
  static constexpr const char* name = "RatedTarget";
  static constexpr const char* about = "The plate that facets of one lens step just detect at their rated distance.";
  static constexpr std::tuple all{
      FIELD(lens_step, IntegerRange{.min = 1, .max = 99}, "of which facets"),
      FIELD(width_m, NumberRange{.above = 0.0, .max = 10.0}, "of the plate"),
      FIELD(height_m, NumberRange{.above = 0.0, .max = 10.0}, "of the plate"),
      FIELD(speed_m_s, NumberRange{.above = 0.0, .max = 20.0}, "sideways"),
      FIELD(contrast_k, NumberRange{.above = 0.0, .max = 40.0}, "by how much it is warmer than what is behind it"),
      FIELD(zones, IntegerRange{.min = 1, .max = 2}, "that it crosses")};
};
template <>
struct Fields<SensitivitySpec> {
  using S = SensitivitySpec;
  static constexpr const char* name = "Sensitivity";
  static constexpr const char* about =
      "How sensitive sensors of this make are where they hang, relative to what the rated distances tell; log-normal.";
  static constexpr std::tuple all{
      FIELD(median, NumberRange{.above = 0.0, .max = 100.0}, "over rooms and units"),
      FIELD(installation_sd, NumberRange{.min = 0.0, .max = 2.0}, "standard deviation of the logarithm over rooms"),
      FIELD(sd, NumberRange{.min = 0.0, .max = 2.0}, "of the logarithm over the units of a room")};
};
template <>
struct Fields<ArraySpec> {
  using S = ArraySpec;
  static constexpr const char* name = "Array";
  static constexpr const char* about = "A thermopile array: what each pixel sees, as a temperature.";
  static constexpr std::tuple all{
      FIELD(rows, IntegerRange{.min = 1, .max = 480}, "of pixels"),
      FIELD(columns, IntegerRange{.min = 1, .max = 640}, "of pixels"),
      FIELD(wide_deg, NumberRange{.above = 0.0, .max = 150.0}, "field of view from the left edge to the right"),
      FIELD(tall_deg, NumberRange{.above = 0.0, .max = 150.0}, "from the upper edge to the lower"),
      FIELD(pixel_deg, NumberRange{.above = 0.0, .max = 90.0},
            "full width at half of a pixel's Gaussian response; by default as far as from pixel to pixel"),
      FIELD(rate_hz, NumberRange{.above = 0.0, .max = 1000.0}, "frames a second; with two sub-pages, sub-pages"),
      FIELD(sub_pages, IntegerRange{.min = 1, .max = 2},
            "2: each frame renews every other pixel, as the squares of a chess board"),
      FIELD(netd_k, accepted::array_noise_k, "noise of one pixel at 1 frame/s, rms; it grows as the root of the rate"),
      FIELD(centre_noise, NumberRange{.min = 0.0, .max = 100.0}, "times that, in the middle"),
      FIELD(corner_noise, NumberRange{.min = 0.0, .max = 100.0}, "times that, in a corner"),
      FIELD(common_k, accepted::array_noise_k, "noise at 1 frame/s, rms, that all pixels of one frame have in common"),
      FIELD(offset_k, accepted::array_noise_k, "rms over units of what all pixels are off"),
      FIELD(column_k, accepted::array_noise_k, "rms of what the pixels of one column are always off"),
      FIELD(fixed_k, accepted::array_noise_k, "rms of what one pixel is always off"),
      FIELD(dead_pixels, IntegerRange{.min = 0, .max = 100}, "of a unit; they read nothing"),
      FIELD(step_k, accepted::array_noise_k, "readings are multiples of it; 0: any number"),
      FIELD(from_um, NumberRange{.min = 1.0, .max = 50.0}, "shortest wavelength that the window lets through"),
      FIELD(to_um, NumberRange{.min = 1.0, .max = 50.0}, "longest one"),
      FIELD(rays_per_pixel, IntegerRange{.min = 1, .max = 10000}, "all pixels share the rays of the whole field")};
};
template <>
struct Fields<SensorModelSpec> {
  using S = SensorModelSpec;
  static constexpr const char* name = "SensorModel";
  static constexpr const char* about = "A sensor's lens and electronics. `pirsim.sensor_model()` has the shipped ones.";
  static constexpr std::tuple all{
      FIELD(id, "as scenes name it"), LABEL(description, "free text"), LABEL(names, "of products that carry it"),
      // less leaves no digits to directions
      FIELD(plane_m, NumberRange{.min = 1e-3, .max = 1000.0}, "distance of the plane on which the zones are drawn"),
      FIELD(clusters), FIELD(targets, "of lens steps whose rated target isn't the usual one"),
      FIELD(sensitivity, "of sensors where they hang, relative to what is rated"),
      FIELD(response,
            "`zones`: a change of activity is motion; `analog`: the physical response; `beam`: a light barrier"),
      FIELD(optics, "for the physical response"), FIELD(detector, "electronics, for the physical response"),
      FIELD(idle_share, NumberRange{.above = 0.0, .max = 1.0},
            "of a beam: what is nearer than this share of the distance to the room breaks it"),
      FIELD(array, "it is a thermopile array, which `Scene.arrays` name")};
};

// Fields of scenes (schema/fields.hpp).

template <>
struct Fields<TriMesh> {
  using S = TriMesh;
  static constexpr const char* name = "Mesh";
  static constexpr const char* about = "Triangles that hide what is behind them.";
  static constexpr std::tuple all{FIELD(name), FIELD(positions), FIELD(triangles), FIELD(solidity),
                                  FIELD(temperature_c, accepted::surface_c)};
};
template <>
struct Fields<SensorSpec> {
  using S = SensorSpec;
  static constexpr const char* name = "Sensor";
  static constexpr const char* about = "A sensor looks along its frame's -Z.";
  static constexpr std::tuple all{FIELD(id), FIELD(model, "key into `Scene.sensor_models`"), FIELD(world_from_sensor),
                                  FIELD(gain, NumberRange{.above = 0.0, .max = 100.0},
                                        "of its signal, relative to what its make's rated distances say; for the "
                                        "analog response"),
                                  FIELD(area, "id of the area that it watches; none: the one below it")};
};
template <>
struct Fields<SeatSpec> {
  using S = SeatSpec;
  static constexpr const char* name = "Seat";
  static constexpr const char* about = "The sitter's pelvis rests at the origin and faces -Z.";
  static constexpr std::tuple all{FIELD(id), FIELD(world_from_seat),
                                  FIELD(uses, "`for` of a mark; none: for anything")};
};
template <>
struct Fields<PlaceSpec> {
  using S = PlaceSpec;
  static constexpr const char* name = "Place";
  static constexpr const char* about =
      "A place to lie (the pelvis on the origin, the head towards +Z) or to stand (facing -Z). One to sit is a `Seat`.";
  static constexpr std::tuple all{FIELD(id), FIELD(posture), FIELD(world_from_place),
                                  FIELD(uses, "`for` of a mark; none: for anything")};
};
template <>
struct Fields<EntranceSpec> {
  using S = EntranceSpec;
  static constexpr const char* name = "Entrance";
  static constexpr const char* about = "A doorway: the origin is the middle of the threshold, -Z points into the room.";
  static constexpr std::tuple all{
      FIELD(id), FIELD(world_from_entrance),
      // assumed: nobody passes a narrower gap or waits farther off
      FIELD(width_m, NumberRange{.min = 0.3, .max = 20.0}, "of the opening"),
      FIELD(outside_m, NumberRange{.min = 0.3, .max = 50.0}, "how far behind it people wait")};
};
template <>
struct Fields<AreaSpec> {
  using S = AreaSpec;
  static constexpr const char* name = "Area";
  static constexpr const char* about = "A named part of the floor: people are counted in each.";
  static constexpr std::tuple all{FIELD(id), FIELD(outline)};
};
template <>
struct Fields<DoorSpec> {
  using S = DoorSpec;
  static constexpr const char* name = "Door";
  static constexpr const char* about =
      "A door with a leaf: the origin is the middle of the threshold, -Z leads through the opening.";
  // Defaults are assumed: leaves of flats are 0.6 to 0.9 m wide and 2 m high (ranges tried: turn_s 0.5-2, shut_share
  // 0.2-1, stands_open_s 30-1800).
  static constexpr std::tuple all{
      FIELD(id),
      FIELD(world_from_door),
      FIELD(width_m, NumberRange{.min = 0.4, .max = 5.0}, "of the leaf"),
      FIELD(height_m, NumberRange{.min = 0.5, .max = 10.0}, "of the leaf"),
      FIELD(thickness_m, NumberRange{.min = 0.005, .max = 0.3}, "of the leaf"),
      FIELD(hinge, "at which side whoever goes through along -Z sees it: `left` or `right`"),
      FIELD(opens, "to which side: `inward`, where -Z points, or `outward`"),
      FIELD(open_deg, NumberRange{.min = 5.0, .max = 180.0}, "how far the leaf turns"),
      FIELD(turn_s, NumberRange{.min = 0.1, .max = 60.0}, "how long that takes"),
      FIELD(state, "as people leave it: `open`, `shut`, or by `habit`"),
      FIELD(shut_share, accepted::probability, "by habit: share of passes after which it is shut at once"),
      FIELD(stands_open_s, NumberRange{.min = 0.0, .max = 86400.0},
            "by habit: how long it stands open after the others")};
};
template <>
struct Fields<SceneSpec> {
  using S = SceneSpec;
  static constexpr const char* name = "Scene";
  static constexpr const char* about = "A room: what hides, where the sensors hang, where people sit, enter and walk.";
  static constexpr std::tuple all{LABEL(name),
                                  FIELD(meshes),
                                  FIELD(sensors, "in the order of the output's columns"),
                                  FIELD(seats),
                                  FIELD(places, "to lie and to stand"),
                                  FIELD(entrances),
                                  FIELD(doors),
                                  FIELD(floor),
                                  FIELD(areas, "apart from each other, in the order of the output's columns"),
                                  FIELD(sensor_models, "every model that a sensor names"),
                                  FIELD(arrays, "sensors that give frames instead of a column"),
                                  LABEL(files, "all that was read"),
                                  LABEL(warnings)};
};

// Fields of trials, of how they are sensed, and of what is known of them (schema/fields.hpp).

template <>
struct Fields<PetSpec> {
  using S = PetSpec;
  static constexpr const char* name = "Pet";
  static constexpr const char* about = "An animal that moves by itself; nobody counts it.";
  static constexpr std::tuple all{
      FIELD(id, "default: its kind"),
      FIELD(kind),
      FIELD(height_m, NumberRange{.min = 0.1, .max = 1.0}, "of the back, standing; none: as the kind usually is"),
      FIELD(length_m, NumberRange{.min = 0.2, .max = 1.5}, "nose to rump; the same"),
      FIELD(mass_kg, NumberRange{.min = 1.0, .max = 90.0}, "the same"),
      LABEL(where)};
};
template <>
struct Fields<TrialSpec> {
  using S = TrialSpec;
  static constexpr const char* name = "Trial";
  static constexpr const char* about = "One choreography; a study runs every trial once per replicate.";
  static constexpr std::tuple all{FIELD(id, "as the output names it"),
                                  FIELD(people, "the first one's actions name the rows' phase"),
                                  FIELD(duration_s, NumberRange{.min = 1.0, .max = 1e7},
                                        "of a run; none: until everybody has carried out all actions"),
                                  FIELD(schedule),
                                  FIELD(occupancy),
                                  FIELD(pets, "move by themselves")};
};
template <>
struct Fields<SensingSpec> {
  using S = SensingSpec;
  static constexpr const char* name = "Sensing";
  static constexpr const char* about = "How sensors are read.";
  static constexpr std::tuple all{
      FIELD(tick_rate_hz, IntegerRange{.min = 1, .max = 10000}),
      FIELD(ticks_per_window, "a row and its bits cover this many ticks"),
      FIELD(rays_per_zone),
      FIELD(change_per, "whose change of activity is motion"),
      FIELD(reader, "when in a window each sensor is asked"),
      FIELD(response, std::array{Response::zones, Response::analog}, "of all sensors but beams; none: each its own"),
      FIELD(units,
            "how sensitive analog sensors are: `typical` of their make, `low`, which nine in ten exceed, as rated "
            "(`guaranteed`), or `drawn`"),
      FIELD(ambient_c, accepted::skin_c, "of surfaces and of the air, where the scene says nothing else"),
      FIELD(analog_rays_per_zone, IntegerRange{.min = 1, .max = 10000}, "in the physical response"),
      FIELD(frame_rate_hz, NumberRange{.above = 0.0, .max = 1000.0}, "of all arrays; none: each its own")};
};
template <>
struct Fields<SummarySpec> {
  using S = SummarySpec;
  static constexpr const char* name = "Summary";
  static constexpr const char* about =
      "Which rows the command line's --summary adds up, and what they are compared with.";
  static constexpr std::tuple all{
      FIELD(phases, "rows in these phases count"),
      FIELD(reference_file, "CSV with measured sums, or empty; beside the script, or a shipped one"), LABEL(where)};
};
template <>
struct Fields<EffectSpec> {
  using S = EffectSpec;
  static constexpr const char* name = "Effect";
  static constexpr const char* about =
      "Something that the plain model leaves out; `pirsim.effects()` lists all. What isn't given is the typical value.";
  static constexpr std::tuple all{FIELD(name), FIELD(parameters, "by name with unit: {\"sigma_deg\": 1.0}"),
                                  FIELD(choices, "{\"sensor\": \"PIR3\"}"), LABEL(where)};
};
template <>
struct Fields<ScriptSpec> {
  using S = ScriptSpec;
  static constexpr const char* name = "Script";
  static constexpr const char* about = "A study: people and their actions, the trials, how sensors are read.";
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(trials),
      FIELD(seed, accepted::seed),
      FIELD(replicates, IntegerRange{.min = 1, .max = 10000000}),
      FIELD(sensing),
      FIELD(effects),
      FIELD(summary),
      FIELD(begin,
            "local date and time at which every run begins, \"2026-03-02T07:00\"; empty: no clock, or the schedule's"),
      LABEL(directory, "of the script file, for relative references"),
      LABEL(files, "all that was read"),
      LABEL(warnings)};
};

template <>
struct Fields<NuisanceSpec> {
  using S = NuisanceSpec;
  static constexpr std::tuple all{
      FIELD(seat_position_m, NumberRange{.min = 0.0, .max = 0.2}, "of each horizontal coordinate of a seat"),
      FIELD(sensor_yaw_deg, NumberRange{.min = 0.0, .max = 10.0}, "of each sensor"),
      FIELD(sensor_tilt_deg, NumberRange{.min = 0.0, .max = 10.0}, "of each sensor"),
      FIELD(body_size, NumberRange{.min = 0.0, .max = 0.2}, "of stature, relative; mass follows with its cube"),
      FIELD(arm_amplitude, NumberRange{.min = 0.0, .max = 0.5}, "of desk work, relative"),
      FIELD(uneven_arms, NumberRange{.min = 0.0, .max = 1.0}, "upper end of the spread of `uneven_arms`"),
      FIELD(trunk_sway_deg, NumberRange{.min = 0.0, .max = 12.0}, "upper end of the amplitude of `trunk_sway`"),
      FIELD(sensor_gain, NumberRange{.min = 0.0, .max = 0.9}, "of each analog sensor's signal, relative"),
      FIELD(ambient_c, NumberRange{.min = 0.0, .max = 15.0}, "of the room's temperature, where any sensor is analog"),
      FIELD(time_s, NumberRange{.min = 0.0, .max = 600.0}, "of each coming and going that an occupancy's counts tell"),
      FIELD(own_seats, NumberRange{.min = 0.0, .max = 1.0},
            "upper end of the share of an occupancy's spare seats that nobody takes")};
};

// Fields of people as counts tell them (schema/fields.hpp).

template <>
struct Fields<AreaCountsSpec> {
  using S = AreaCountsSpec;
  static constexpr const char* name = "AreaCounts";
  static constexpr const char* about = "How many people were in one area, at the moments of `Counts.times_s`.";
  static constexpr std::tuple all{FIELD(area, "its id"), FIELD(people, "at each moment"),
                                  FIELD(column, "of `Counts.file`")};
};
template <>
struct Fields<CountsSpec> {
  using S = CountsSpec;
  static constexpr const char* name = "Counts";
  static constexpr const char* about = "How many people were there, at moments.";
  static constexpr std::tuple all{
      FIELD(times_s, "ascending"),
      FIELD(people, "at each of them, in all"),
      FIELD(areas, "counted by themselves; the rest of the people are elsewhere"),
      FIELD(begin, "local date and time of `times_s` 0; empty: they are seconds of the run"),
      FIELD(file, "CSV, or empty; relative to `Script.directory`; `read_script()` reads it"),
      FIELD(time, "its column of times; empty: found by its usual names"),
      FIELD(column, "its column of people; empty: found by its usual names"),
      LABEL(most)};
};
template <>
struct Fields<StaySpec> {
  using S = StaySpec;
  static constexpr const char* name = "Stay";
  static constexpr const char* about = "Somebody at one place for a while.";
  static constexpr std::tuple all{FIELD(person),
                                  FIELD(seat, "or empty: on foot"),
                                  FIELD(from_s, accepted::at_s),
                                  FIELD(to_s, accepted::at_s),
                                  FIELD(points, "where they were at `from_s` and at `to_s`, if that is known"),
                                  FIELD(then, "to the person's next stay, or outside until that begins"),
                                  LABEL(where)};
};
template <>
struct Fields<PlacesSpec> {
  using S = PlacesSpec;
  static constexpr const char* name = "Places";
  static constexpr const char* about = "Who took which seat, and when.";
  static constexpr std::tuple all{FIELD(stays, "of each person in order of time"),
                                  FIELD(begin, "local date and time of second 0; empty: seconds of the run"),
                                  FIELD(file, "CSV, or empty; relative to `Script.directory`")};
};
template <>
struct Fields<TrackSpec> {
  using S = TrackSpec;
  static constexpr const char* name = "Track";
  static constexpr const char* about = "Where one person was, from moment to moment.";
  static constexpr std::tuple all{FIELD(person), FIELD(times_s, "ascending"), FIELD(points, "at each of them"),
                                  FIELD(headings_deg, "at each of them; empty: facing where they go"), LABEL(where)};
};
template <>
struct Fields<PositionsSpec> {
  using S = PositionsSpec;
  static constexpr const char* name = "Positions";
  static constexpr const char* about = "Tracked people, who go where they went.";
  static constexpr std::tuple all{FIELD(tracks),
                                  FIELD(begin, "local date and time of second 0; empty: seconds of the run"),
                                  FIELD(file, "CSV, or empty; relative to `Script.directory`")};
};
template <>
struct Fields<OccupancySpec> {
  using S = OccupancySpec;
  static constexpr const char* name = "Occupancy";
  static constexpr const char* about =
      "Adds people who are there as data say: one of `counts`, `places` and `positions`.";
  static constexpr std::tuple all{
      FIELD(counts, "who comes, when within an interval, and where they sit is drawn anew for every run"),
      FIELD(places),
      FIELD(positions),
      FIELD(from_h, accepted::hour_of_day, "with either, replicates are the days of the data, each from here"),
      FIELD(to_h, accepted::hour_of_day, "to there"),
      FIELD(changes_within_s, NumberRange{.min = 0.0, .max = 1e7},
            "of counts: a change happened at most so long before its reading; none: since the reading before"),
      FIELD(persons, accepted::people_of_counts,
            "of counts: how many different ones come; none: as many as are ever there"),
      FIELD(seats, "of counts: that may be taken; none: all of the scene"),
      FIELD(entrances, "that people use; none: all of the scene"),
      FIELD(style),
      LABEL(where)};
};

// Fields of days at work and at home (schema/fields.hpp).

template <>
struct Fields<ClockSpec> {
  using S = ClockSpec;
  static constexpr const char* name = "Clock";
  static constexpr const char* about = "A time of day: normal, cut at three standard deviations.";
  static constexpr std::tuple all{FIELD(mean_h, accepted::hour_of_day),
                                  FIELD(sd_min, NumberRange{.min = 0.0, .max = 240.0})};
};
template <>
struct Fields<StaffSpec> {
  using S = StaffSpec;
  static constexpr auto enough_for_seats = [](const StaffSpec& staff) {
    return IntegerRange{.min = std::max(1LL, static_cast<long long>(staff.seats.size())), .max = 200};
  };
  static constexpr const char* name = "Staff";
  static constexpr const char* about = "People of one role.";
  static constexpr std::tuple all{FIELD(role), FIELD(count, enough_for_seats),
                                  FIELD(seats, "their own desks; none: the scene's seats that nobody has, in order"),
                                  LABEL(where)};
};
template <>
struct Fields<HeldMeetingSpec> {
  using S = HeldMeetingSpec;
  static constexpr const char* name = "HeldMeeting";
  static constexpr const char* about = "A meeting whose time is known.";
  static constexpr std::tuple all{FIELD(at_h, accepted::hour_of_day), FIELD(duration_min, accepted::meeting_min),
                                  FIELD(people, accepted::people_at_once), LABEL(where)};
};
template <>
struct Fields<MeetingsSpec> {
  using S = MeetingsSpec;
  static constexpr auto no_fewer_meetings = [](const MeetingsSpec& meetings) {
    return IntegerRange{.min = meetings.fewest_a_day, .max = accepted::meetings_a_day.max};
  };
  static constexpr auto no_fewer_people = [](const MeetingsSpec& meetings) {
    return IntegerRange{.min = meetings.fewest_people, .max = accepted::people_at_once.max};
  };
  static constexpr const char* name = "Meetings";
  static constexpr const char* about = "Meetings that are held in a room.";
  static constexpr std::tuple all{FIELD(attendees, "who sits in them: people who come for them, or the staff"),
                                  FIELD(area, "where the room is one of several"),
                                  FIELD(fewest_a_day, accepted::meetings_a_day),
                                  FIELD(most_a_day, no_fewer_meetings),
                                  FIELD(fewest_people, accepted::people_at_once),
                                  FIELD(most_people, no_fewer_people, "none: 8, or as many as there are seats"),
                                  FIELD(durations_min, accepted::meeting_min),
                                  FIELD(probabilities, accepted::probability, "of each duration"),
                                  FIELD(from_h, accepted::hour_of_day, "when the first may begin"),
                                  FIELD(to_h, accepted::hour_of_day, "when the last has ended"),
                                  FIELD(lateness_min, NumberRange{.min = 0.0, .max = 60.0},
                                        "mean of how much later than its beginning people come"),
                                  FIELD(held, "these, every working day, instead of drawn ones"),
                                  FIELD(seats, "none: those of the area that are nobody's own desk"),
                                  LABEL(where)};
};
template <>
struct Fields<ResidentSpec> {
  using S = ResidentSpec;
  static constexpr const char* name = "Resident";
  static constexpr const char* about = "Somebody who lives in a home.";
  static constexpr std::tuple all{
      FIELD(id, "as `--occupants` names them"), FIELD(occupation),
      FIELD(age_years, NumberRange{.min = 16.0, .max = 110.0}, "how often they get up at night goes by it"),
      FIELD(bed, "a place to lie; empty: one of the scene's for sleep that nobody has, in order"), LABEL(where)};
};
template <>
struct Fields<HouseholdSpec> {
  using S = HouseholdSpec;
  static constexpr const char* name = "Household";
  static constexpr const char* about = "Who lives in a home; their days go from 04:00 to 04:00.";
  static constexpr std::tuple all{
      FIELD(residents, "one to five"),
      FIELD(visits_a_week, NumberRange{.min = 0.0, .max = 7.0}, "evenings on which somebody comes"),
      FIELD(wakes, "on working days"),
      FIELD(wakes_on_free_days),
      FIELD(goes_to_bed),
      FIELD(leaves, "who works, on working days; who works at home begins then"),
      FIELD(comes_home),
      FIELD(lunch),
      FIELD(dinner)};
};
template <>
struct Fields<ScheduleSpec> {
  using S = ScheduleSpec;
  static constexpr const char* name = "Schedule";
  static constexpr const char* about =
      "Adds people whose actions are drawn anew for every run; replicates are days that follow each other.";
  static constexpr std::tuple all{
      FIELD(first_day, "ISO 8601"),
      FIELD(from_h, accepted::hour_of_day, "the part of the day that a run simulates begins"),
      FIELD(to_h, accepted::hour_or_next_days, "and ends; with a household 28, four o'clock of the next day"),
      FIELD(staff),
      FIELD(meetings, "of each room in which some are held"),
      FIELD(household, "instead of staff, meetings and cleaning"),
      FIELD(arrival),
      FIELD(departure),
      FIELD(lunch),
      FIELD(lunch_min, NumberRange{.min = 0.0, .max = 240.0}, "mean of its length"),
      FIELD(lunch_sd_min, NumberRange{.min = 0.0, .max = 120.0}),
      FIELD(cleaning_h, accepted::hour_of_day, "somebody cleans then, on working days"),
      FIELD(entrances, "that people use, each their own; none: all of the scene"),
      FIELD(style),
      LABEL(where)};
};

// Fields of coverage studies, walk tests and placements (schema/fields.hpp).

template <>
struct Fields<TurnSpec> {
  using S = TurnSpec;
  static constexpr std::tuple all{FIELD(axis), FIELD(deg_per_s, NumberRange{.min = -3600.0, .max = 3600.0})};
};
template <>
struct Fields<XShapesSpec> {
  using S = XShapesSpec;
  static constexpr std::tuple all{
      FIELD(heights_m, NumberRange{.min = 0.0, .max = 10.0}, "of the crosses' centres over the floor"),
      FIELD(bar_length_m, NumberRange{.above = 0.0, .max = 5.0}, "from tip to tip, caps included"),
      FIELD(bar_width_m, NumberRange{.above = 0.0, .max = 1.0}, "diameter"),
      FIELD(temperature_c, accepted::surface_c, "of the crosses, for the physical response, which has no noise here"),
      FIELD(turns)};
};
template <>
struct Fields<CoverageSpec> {
  using S = CoverageSpec;
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(sensing),
      FIELD(spacing_m, NumberRange{.min = 0.005, .max = 10.0}, "side of a square"),
      FIELD(duration_s, NumberRange{.above = 0.0, .max = 3600.0}, "in every square; a whole number of windows"),
      FIELD(without, "what is taken out of the room: meshes of this name, or of this first word"),
      LABEL(without_where),
      FIELD(target),
      FIELD(seed, accepted::seed),
      FIELD(effects)};
};
template <>
struct Fields<MountingLineSpec> {
  using S = MountingLineSpec;
  static constexpr std::tuple all{FIELD(from), FIELD(to),
                                  FIELD(yaw_deg, accepted::turned_deg, "0 facing -Z, positive turning left"),
                                  FIELD(tilt_deg, accepted::tilted_deg, "downwards")};
};
template <>
struct Fields<PlacementSearchSpec> {
  using S = PlacementSearchSpec;
  static constexpr std::tuple all{
      FIELD(n_sensors, IntegerRange{.min = 1, .max = 20}), FIELD(model), FIELD(lines),
      FIELD(evaluations, IntegerRange{.min = 1, .max = 100000},
            "sensor sets that are tried; by seats and false_off: places of one sensor, evenly along the lines")};
};
template <>
struct Fields<PlacementLightSpec> {
  using S = PlacementLightSpec;
  static constexpr std::tuple all{
      FIELD(people),
      FIELD(delay_min, NumberRange{.min = 0.0, .max = 1440.0}, "from the last motion until the light goes off"),
      FIELD(wave_s, NumberRange{.min = 0.0, .max = 3600.0},
            "who is in the dark has brought the light back so long after (assumed; 0 to 60 tried)")};
};
template <>
struct Fields<PlacementSpec> {
  using S = PlacementSpec;
  static constexpr std::tuple all{FIELD(coverage), FIELD(by, "what sets are ranked by and a search looks for"),
                                  LABEL(by_where), FIELD(light),
                                  FIELD(sets),     FIELD(search),
                                  LABEL(models)};
};
template <>
struct Fields<WalkRequirement> {
  using S = WalkRequirement;
  static constexpr std::tuple all{
      FIELD(within_s, NumberRange{.above = 0.0, .max = 600.0}, "from the start of the movement"),
      FIELD(probability, NumberRange{.above = 0.0, .max = 1.0}, "required share of noticed tries"),
      FIELD(directions, IntegerRange{.min = 1, .max = 360}, "number of directions tried, evenly spaced")};
};
template <>
struct Fields<SwingingArmSpec> {
  using S = SwingingArmSpec;
  static constexpr std::tuple all{
      FIELD(length_m, NumberRange{.above = 0.0, .max = 2.0}, "from its axis to its tip"),
      FIELD(width_m, NumberRange{.above = 0.0, .max = 1.0}, "both ways across"),
      FIELD(height_m, NumberRange{.min = 0.2, .max = 3.0}, "of its axis over the floor"),
      FIELD(swing_deg, NumberRange{.above = 0.0, .max = 360.0}, "there, and the same back"),
      FIELD(deg_per_s, NumberRange{.above = 0.0, .max = 3600.0}),
      FIELD(temperature_c, accepted::surface_c, "of its surface, for the analog response (assumed: as skin)"),
      FIELD(swings, "horizontal, vertical: each in every direction")};
};
template <>
struct Fields<WalkTestSpec> {
  using S = WalkTestSpec;
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(sensing),
      FIELD(spacing_m, NumberRange{.min = 0.05, .max = 10.0}, "of the points"),
      FIELD(person),
      FIELD(major),
      FIELD(path_m, NumberRange{.min = 0.5, .max = 20.0}, "length of the straight walk; the point is its middle"),
      FIELD(stop_s, NumberRange{.min = 0.0, .max = 60.0},
            "in place of within_s: motion counts until the walker has stood so long at the end of the path"),
      FIELD(minor),
      FIELD(arm),
      FIELD(seat_height_m, NumberRange{.min = 0.3, .max = 0.8}, "of the pelvis"),
      FIELD(desk_height_m, NumberRange{.min = 0.5, .max = 1.1}, "of the forearms"),
      FIELD(arm_amplitude_m, NumberRange{.min = 0.0, .max = 0.15}),
      FIELD(arm_period_s, NumberRange{.min = 0.5, .max = 60.0}),
      FIELD(seed, accepted::seed),
      FIELD(effects)};
};

}  // namespace pirsim

// Every spec's fields, said once: what is called how, which numbers are accepted, what it means. A field that is added
// to a struct is added here, without which nothing compiles that goes through all fields; fingerprints, comparisons,
// checks, plain keys of files, Python's classes and the pages' tables of keys then follow (tools/specs).

namespace pirsim {

/// Specs that Python has classes of, each before those that it is a part of.
using SpecsOfPython =
    std::tuple<Where, InputFile, SensorSpec, SeatSpec, PlaceSpec, EntranceSpec, DoorSpec, OpticsSpec, ElementSpec,
               AmplifierSpec, ComparatorSpec, ReportSpec, DetectorSpec, ZoneSpec, ClusterSpec, RatedTargetSpec,
               SensitivitySpec, ArraySpec, SensorModelSpec, AreaSpec, SceneSpec, action::Wait, action::Appear,
               action::Enter, action::Walk, action::Sit, action::Work, action::Rise, action::Leave, action::Turn,
               action::Follow, action::Lie, action::Stand, SeatScatterSpec, WarmthSpec, PersonSpec, ClockSpec,
               StaffSpec, HeldMeetingSpec, MeetingsSpec, ResidentSpec, HouseholdSpec, ScheduleSpec, AreaCountsSpec,
               CountsSpec, StaySpec, PlacesSpec, TrackSpec, PositionsSpec, OccupancySpec, PetSpec, TrialSpec,
               SensingSpec, SummarySpec, EffectSpec, ScriptSpec>;

}  // namespace pirsim
