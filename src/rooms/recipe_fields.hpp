// Fields of recipes: of the rooms, flats and households that they draw, and of datasets (schema/field.hpp).
#pragma once

#include <tuple>

#include "model/schema/checks.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/dataset.hpp"
#include "pirsim/flat.hpp"
#include "pirsim/room.hpp"

namespace pirsim {

template <>
struct Words<dataset::RoomKind> {
  static constexpr WordList<dataset::RoomKind, 2> all{
      {{"office", dataset::RoomKind::office}, {"meeting", dataset::RoomKind::meeting}}};
};
template <>
struct Words<dataset::DeskOrder> {
  static constexpr WordList<dataset::DeskOrder, 3> all{{{"islands", dataset::DeskOrder::islands},
                                                        {"rows", dataset::DeskOrder::rows},
                                                        {"walls", dataset::DeskOrder::walls}}};
};
template <>
struct Words<dataset::Mount> {
  static constexpr WordList<dataset::Mount, 3> all{
      {{"ceiling", dataset::Mount::ceiling}, {"corner", dataset::Mount::corner}, {"wall", dataset::Mount::wall}}};
};
template <>
struct Words<dataset::FlatRoomKind> {
  using K = dataset::FlatRoomKind;
  static constexpr WordList<K, 6> all{{{"living_room", K::living_room},
                                       {"kitchen", K::kitchen},
                                       {"bedroom", K::bedroom},
                                       {"study", K::study},
                                       {"bath", K::bath},
                                       {"corridor", K::corridor}}};
};
template <>
struct Words<dataset::PlanSide> {
  using S = dataset::PlanSide;
  static constexpr WordList<S, 4> all{{{"bottom", S::bottom}, {"right", S::right}, {"top", S::top}, {"left", S::left}}};
};
template <>
struct Words<dataset::PlanCorner> {
  using C = dataset::PlanCorner;
  static constexpr WordList<C, 4> all{{{"bottom_left", C::bottom_left},
                                       {"bottom_right", C::bottom_right},
                                       {"top_left", C::top_left},
                                       {"top_right", C::top_right}}};
};
template <>
struct Words<dataset::PlanLeaf> {
  using L = dataset::PlanLeaf;
  static constexpr WordList<L, 4> all{{{"none", L::none}, {"open", L::open}, {"shut", L::shut}, {"habit", L::habit}}};
};
template <>
struct Words<dataset::PieceKind> {
  using K = dataset::PieceKind;
  static constexpr WordList<K, 15> all{{{"bed", K::bed},
                                        {"sofa", K::sofa},
                                        {"table", K::table},
                                        {"kitchen", K::kitchen},
                                        {"counter", K::counter},
                                        {"stove", K::stove},
                                        {"sink", K::sink},
                                        {"fridge", K::fridge},
                                        {"shower", K::shower},
                                        {"toilet", K::toilet},
                                        {"washbasin", K::washbasin},
                                        {"wardrobe", K::wardrobe},
                                        {"desk", K::desk},
                                        {"shelf", K::shelf},
                                        {"television", K::television}}};
};
template <>
struct Words<dataset::FlatLayout> {
  static constexpr WordList<dataset::FlatLayout, 3> all{{{"corridor", dataset::FlatLayout::corridor},
                                                         {"hall", dataset::FlatLayout::hall},
                                                         {"open", dataset::FlatLayout::open}}};
};
template <>
struct Words<dataset::SensorsAt> {
  static constexpr WordList<dataset::SensorsAt, 2> all{
      {{"room", dataset::SensorsAt::rooms}, {"doorway", dataset::SensorsAt::doorways}}};
};
template <>
struct Words<dataset::VariedEffectSpec::Per> {
  static constexpr WordList<dataset::VariedEffectSpec::Per, 2> all{
      {{"room", dataset::VariedEffectSpec::Per::room}, {"day", dataset::VariedEffectSpec::Per::day}}};
};
template <>
struct Words<dataset::Export> {
  static constexpr WordList<dataset::Export, 3> all{{{"uci864", dataset::Export::uci864},
                                                     {"casas", dataset::Export::casas},
                                                     {"energyplus", dataset::Export::energyplus}}};
};

namespace accepted {

inline constexpr NumberRange side_m{.min = 1.5, .max = 100.0};
inline constexpr NumberRange on_page_m{.min = -1000.0, .max = 1000.0};
inline constexpr IntegerRange rooms_alike{.min = 1, .max = static_cast<long long>(limits::rooms)};

}  // namespace accepted

template <>
struct Fields<dataset::SensorGroupSpec> {
  using S = dataset::SensorGroupSpec;
  static constexpr const char* name = "sensor_group";
  static constexpr std::tuple all{
      FIELD(mount, "required; a ceiling's looks down, turned any way, a corner's along the bisector of its walls"),
      field("model", &S::models,
            "or several, of which each sensor is one; default EKMC1601111 on ceilings, EKMC1604111 else"),
      FIELD(count, IntegerRange{.min = 0, .max = 50}),
      FIELD(height_m, NumberRange{.min = 0.1, .max = 20.0}, "above the floor, of those on walls"),
      FIELD(tilt_deg, accepted::tilted_deg, "of their axis below the horizon"),
      LABEL(where)};
};
template <>
struct Fields<dataset::RoomSpec> {
  using S = dataset::RoomSpec;
  static constexpr const char* name = "room";
  static constexpr std::tuple all{
      FIELD(kind, "`meeting`: one table, chairs around it; `home`: below"),
      FIELD(width_m, accepted::side_m, "along x"),
      FIELD(depth_m, accepted::side_m, "along -z"),
      FIELD(height_m, NumberRange{.min = 2.2, .max = 20.0}, "of the ceiling"),
      FIELD(l_shaped, accepted::probability, "probability that a far corner is missing"),
      FIELD(cut_share, NumberRange{.min = 0.05, .max = 0.8}, "of width and of depth that this corner takes"),
      FIELD(doors, IntegerRange{.min = 1, .max = 20}, "in any wall but those of the missing corner"),
      FIELD(door_width_m, NumberRange{.min = 0.7, .max = 5.0}),
      FIELD(seats, accepted::people_at_once, "a desk each, or round the table"),
      field("desks", &S::orders, "of offices: one of these is drawn a room"),
      FIELD(desk_width_m, NumberRange{.min = 1.0, .max = 2.4}, "of offices"),
      FIELD(desk_screens, accepted::probability, "probability that islands have screens between facing desks"),
      FIELD(cupboards, IntegerRange{.min = 0, .max = 50}, "before walls, 0.8 to 2 m high"),
      FIELD(partitions, IntegerRange{.min = 0, .max = 50}, "free-standing screens, 1.4 to 1.8 m high"),
      FIELD(sensors, "groups of sensors; default one on the ceiling and one in a corner"),
      LABEL(where)};
};
template <>
struct Fields<dataset::FlatSpec> {
  using S = dataset::FlatSpec;
  static constexpr const char* name = "flat";
  static constexpr std::tuple all{
      FIELD(rooms, IntegerRange{.min = 1, .max = 4},
            "a living room, then bedrooms and perhaps a study; of one room the bed stands in it"),
      FIELD(residents, IntegerRange{.min = 1, .max = 5}, "each has a place to lie"),
      FIELD(size_m2, NumberRange{.min = 15.0, .max = 1000.0},
            "of the floor; default 28 to 42 of one room, 17 to 23 more of each other"),
      FIELD(stretch, NumberRange{.min = 0.3, .max = 4.0}, "width over depth; of one room depth over width"),
      FIELD(height_m, NumberRange{.min = 2.3, .max = 5.0}, "of the ceiling"),
      field("layout", &S::layouts, "how rooms are reached, below; one is drawn"),
      FIELD(own_kitchen, accepted::probability, "probability that the kitchen isn't a part of the living room"),
      FIELD(double_beds, accepted::probability,
            "probability of a wide bed; two share it where there are more of them than rooms"),
      FIELD(study, accepted::probability, "probability that a room that no bed needs is a study"),
      FIELD(sensors_at, "one in every area, or one above every doorway; one is drawn"),
      field("mount", &S::mounts, std::array{dataset::Mount::corner, dataset::Mount::ceiling},
            "of sensors in rooms; one is drawn"),
      field("model", &S::models,
            "or several, of which each sensor is one; default EKMC1604111 in corners, EKMC1601111 on ceilings, "
            "AMN33111 above doorways"),
      LABEL(models_where),
      FIELD(sensor_height_m, NumberRange{.min = 0.1, .max = 5.0}, "of those in corners"),
      FIELD(sensor_tilt_deg, accepted::tilted_deg, "the same"),
      LABEL(where)};
};
template <>
struct Fields<dataset::PlanPieceSpec> {
  using S = dataset::PlanPieceSpec;
  static constexpr const char* name = "plan_piece";
  static constexpr std::tuple all{
      FIELD(kind, "required; `kitchen`: a counter with stove and sink, a fridge at its end"),
      FIELD(wall, "of the page, to which its back is; of a table, along which its long sides are"),
      FIELD(x_m, accepted::on_page_m, "of the middle of its back, of a table's middle; without it where it fits"),
      FIELD(y_m, accepted::on_page_m, "the same; at the `wall` where only the other one is given"),
      FIELD(width_m, NumberRange{.min = 0.3, .max = 6.0},
            "along its back, of a bed, kitchen, counter, stove, sink, fridge, wardrobe, desk, shelf"),
      FIELD(places, IntegerRange{.min = 1, .max = 12}, "of a bed (1 or 2; default 1), a sofa, a table"),
      LABEL(where)};
};
template <>
struct Fields<dataset::PlanSensorSpec> {
  using S = dataset::PlanSensorSpec;
  static constexpr const char* name = "plan_sensor";
  static constexpr std::tuple all{
      FIELD(id, "default PIR_ and its room"),
      FIELD(model, "default EKMC1601111 on the ceiling, EKMC1604111 else"),
      FIELD(corner, "in which it hangs, and looks at the room's middle"),
      FIELD(wall, "or on which, looking straight away; without both it looks down from the ceiling"),
      FIELD(x_m, accepted::on_page_m, "on the wall or the ceiling; default its middle"),
      FIELD(y_m, accepted::on_page_m, "the same"),
      FIELD(height_m, NumberRange{.min = 0.1, .max = 10.0}, "above the floor, in a corner or on a wall"),
      FIELD(tilt_deg, accepted::tilted_deg, "downwards, the same"),
      FIELD(turned_deg, accepted::turned_deg, "to the left of where it looks by itself, seen from above"),
      LABEL(where)};
};
template <>
struct Fields<dataset::PlanRoomSpec> {
  using S = dataset::PlanRoomSpec;
  static constexpr const char* name = "plan_room";
  static constexpr std::tuple all{
      FIELD(id, "required; its area's name in rows"),
      FIELD(kind, "required; by it the room is furnished if `furniture` is missing"),
      FIELD(x_m, accepted::on_page_m,
            "required; [left, right]: up to the middle of inner walls, to the inner face of outer ones"),
      FIELD(y_m, accepted::on_page_m, "required; [bottom, top]"),
      FIELD(area, "default its id; rooms of one area have no wall between them: an L-shaped room"),
      FIELD(furniture),
      FIELD(sensors),
      LABEL(where)};
};
template <>
struct Fields<dataset::PlanDoorSpec> {
  using S = dataset::PlanDoorSpec;
  static constexpr const char* name = "plan_door";
  static constexpr std::tuple all{
      FIELD(id, "default the room that it leads into, or `front`"),
      FIELD(from, "room; without it the door leads in from outside"),
      FIELD(into, "required; room, into which a leaf opens"),
      FIELD(wall, "of the room that it leads into, of a door from outside"),
      FIELD(x_m, accepted::on_page_m,
            "of its middle, in a wall that runs left to right; default the middle of the wall"),
      FIELD(y_m, accepted::on_page_m, "the same in a wall that runs up the page"),
      FIELD(width_m, NumberRange{.min = 0.6, .max = 10.0}, "of the gap in the wall"),
      FIELD(leaf,
            "`none`, or as its [state](scene.md#doors); default `shut` from outside, `habit` into bedrooms and "
            "baths, `none` else"),
      FIELD(hinge, "as who goes through sees it; default at the nearer wall"),
      LABEL(where)};
};
template <>
struct Fields<dataset::HomePlanSpec> {
  using S = dataset::HomePlanSpec;
  static constexpr const char* name = "home_plan";
  static constexpr std::tuple all{LABEL(name), FIELD(height_m, NumberRange{.min = 2.2, .max = 5.0}, "of the ceiling"),
                                  FIELD(rooms), FIELD(doors), LABEL(where)};
};
template <>
struct Fields<dataset::HouseholdRangesSpec> {
  using S = dataset::HouseholdRangesSpec;
  static constexpr const char* name = "household_ranges";
  static constexpr std::tuple all{
      FIELD(works, accepted::probability, "probability that a resident goes to work"),
      FIELD(works_at_home, accepted::probability, "and that one works at home; together at most 1"),
      FIELD(age_years, range_of(field_of<&ResidentSpec::age_years>(), ResidentSpec{})),
      FIELD(visits_a_week, range_of(field_of<&HouseholdSpec::visits_a_week>(), HouseholdSpec{}),
            "evenings on which somebody comes"),
      FIELD(shift_min, NumberRange{.min = -120.0, .max = 120.0},
            "by how much all clocks of a household are later than its usual ones"),
      FIELD(cat, accepted::probability, "probability that they have a [cat](../physics/pets.md)"),
      FIELD(dog, accepted::probability, "the same of a dog"),
      FIELD(usual)};
};
template <>
struct Fields<dataset::VariedEffectSpec> {
  using S = dataset::VariedEffectSpec;
  static constexpr const char* name = "varied_effect";
  static constexpr std::tuple all{LABEL(name),
                                  FIELD(per, "for what it is drawn anew"),
                                  FIELD(chance, accepted::probability, "of being there at all"),
                                  FIELD(parameters),
                                  FIELD(choices),
                                  LABEL(where)};
};
template <>
struct Fields<dataset::RoomGroupSpec> {
  using S = dataset::RoomGroupSpec;
  static constexpr const char* name = "room_group";
  static constexpr std::tuple all{
      FIELD(count, accepted::rooms_alike, "of this kind; without it `scenes` are a room each"),
      FIELD(rooms),
      FIELD(home),
      FIELD(scenes),
      FIELD(schedule),
      FIELD(people, IntegerRange{.min = 0, .max = 200},
            "how many of the schedule's staff a room has, never more than seats; default all"),
      FIELD(ambient_c, accepted::skin_c,
            "of the air, drawn once a room; default [21, 25], of homes [19, 24]; or `sensing.ambient_c` for all"),
      LABEL(where)};
};
template <>
struct Fields<dataset::SplitSpec> {
  using S = dataset::SplitSpec;
  static constexpr const char* name = "split";
  static constexpr std::tuple all{
      FIELD(validation_rooms, accepted::probability, "share of all rooms, with all of their days"),
      FIELD(test_rooms, accepted::probability, "the same"),
      FIELD(test_days, accepted::probability, "share of the other rooms' working days: the last ones")};
};

template <>
struct Fields<dataset::RecipeSpec> {
  using S = dataset::RecipeSpec;
  static constexpr const char* name = "recipe";
  static constexpr std::tuple all{
      LABEL(name),
      FIELD(seed, accepted::seed, "of all random streams"),
      FIELD(rooms, "required; rooms are numbered through, from 1"),
      FIELD(draw_by),
      FIELD(days, IntegerRange{.min = 1, .max = 3'660},  // assumed: ten years
            "of each room, one after the other from `schedule.first_day`"),
      FIELD(ambient_sd_k, NumberRange{.min = 0.0, .max = 10.0}, "by which a room's days differ"),
      FIELD(sensing, "as in a script; `units` are drawn"),
      FIELD(effects),
      FIELD(split),
      FIELD(occupants, "`true`: also who is where, a line a window and person"),
      FIELD(frames, "`true`: also the frames of thermal arrays, a file a room, day and array"),
      FIELD(exports),
      field("rows", &S::ending, "or .csv, .csv.zst"),
      FIELD(pictures, IntegerRange{.min = 0, .max = 1000}, "of so many rooms, the first ones"),
      added("file", &S::file),
      added("overrides", &S::overrides),
      added("given", &S::given),
      added("text", &S::text),
      added("originals", &S::originals),
      added("data_directories", &S::data_directories)};
};

}  // namespace pirsim
