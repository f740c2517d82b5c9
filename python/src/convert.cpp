#include "convert.hpp"

#include <cstring>

namespace pirsim::python {

nb::object spec_class(const char* name) { return nb::module_::import_("pirsim.specs").attr(name); }

void refuse(nb::handle value, const std::string& path, const std::string& what) {
  const auto type = nb::cast<std::string>(value.type().attr("__name__"));
  throw nb::type_error((path + ": expected " + what + ", got a value of type " + type).c_str());
}

nb::object item(nb::handle sequence, std::size_t i) { return nb::borrow<nb::tuple>(sequence)[i]; }

nb::object as_tuple(nb::handle value, const std::string& path, const std::string& what) {
  if (nb::isinstance<nb::str>(value) || nb::isinstance<nb::bytes>(value)) refuse(value, path, what);
  PyObject* tuple = PySequence_Tuple(value.ptr());
  if (tuple == nullptr) {
    PyErr_Clear();
    refuse(value, path, what);
  }
  return nb::steal(tuple);
}

double Convert<double>::from(nb::handle value, const std::string& path) {
  const double number = nb::isinstance<nb::bool_>(value) ? -1.0 : PyFloat_AsDouble(value.ptr());
  if (number != -1.0) return number;
  const bool failed = PyErr_Occurred() != nullptr;
  PyErr_Clear();
  if (failed || nb::isinstance<nb::bool_>(value)) refuse(value, path, "a number");
  return number;
}

std::string Convert<std::string>::from(nb::handle value, const std::string& path) {
  std::string text;
  if (!nb::try_cast<std::string>(value, text)) refuse(value, path, "a text");
  return text;
}

RaysPerZone Convert<RaysPerZone>::from(nb::handle value, const std::string& path) {
  const int n = from_python<int>(value, path);
  for (const auto known : {RaysPerZone::one, RaysPerZone::five, RaysPerZone::nine, RaysPerZone::sixteen}) {
    if (static_cast<int>(known) == n) return known;
  }
  refuse(value, path, "1, 5, 9 or 16");
}

template <>
nb::object Special<Vec2>::to(const Vec2& p) {
  return nb::make_tuple(p.x, p.y);
}
template <>
Vec2 Special<Vec2>::from(nb::handle value, const std::string& path) {
  const auto numbers = from_python<std::array<double, 2>>(value, path);
  return {numbers[0], numbers[1]};
}

template <>
nb::object Special<Vec3>::to(const Vec3& p) {
  return nb::make_tuple(p.x, p.y, p.z);
}
template <>
Vec3 Special<Vec3>::from(nb::handle value, const std::string& path) {
  const auto numbers = from_python<std::array<double, 3>>(value, path);
  return {numbers[0], numbers[1], numbers[2]};
}

template <>
nb::object Special<Frame>::to(const Frame& frame) {
  const Quat& q = frame.rotation;
  return spec_class("Frame")(to_python(frame.origin), nb::make_tuple(q.w, q.x, q.y, q.z));
}
template <>
Frame Special<Frame>::from(nb::handle value, const std::string& path) {
  if (!nb::isinstance(value, spec_class("Frame"))) refuse(value, path, "a pirsim.Frame");
  const auto q = from_python<std::array<double, 4>>(value.attr("rotation"), path + ".rotation");
  return {Quat(q[0], q[1], q[2], q[3]), from_python<Vec3>(value.attr("origin"), path + ".origin")};
}

template <>
nb::object Special<FloorArea>::to(const FloorArea& floor) {
  return spec_class("Floor")(to_python(floor.loops()), to_python(floor.height_m()));
}
template <>
FloorArea Special<FloorArea>::from(nb::handle value, const std::string& path) {
  if (!nb::isinstance(value, spec_class("Floor"))) refuse(value, path, "a pirsim.Floor");
  return {from_python<std::vector<std::vector<Vec2>>>(value.attr("loops"), path + ".loops"),
          from_python<double>(value.attr("height_m"), path + ".height_m")};
}

namespace {

/// Rows of three from whatever numpy makes an array of.
template <typename T, typename Row>
std::vector<Row> rows_of_three(nb::handle value, const char* type, const std::string& path) {
  static_assert(sizeof(Row) == 3 * sizeof(T));
  nb::object array;
  try {
    array = nb::module_::import_("numpy").attr("ascontiguousarray")(value, type);
  } catch (nb::python_error&) {
    refuse(value, path, "an array of shape (n, 3)");
  }
  nb::ndarray<const T, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu> view;
  if (nb::len(value) == 0) return {};
  if (!nb::try_cast(array, view)) refuse(value, path, "an array of shape (n, 3)");
  std::vector<Row> rows(view.shape(0));
  std::memcpy(static_cast<void*>(rows.data()), view.data(), rows.size() * sizeof(Row));
  return rows;
}

/// What numpy would cut off in silence: 1.5 becomes 1, and 2^40 becomes 0.
void require_indices(nb::handle value, const std::string& path) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  nb::object array;
  try {
    array = numpy.attr("asarray")(value);
  } catch (nb::python_error&) {
    refuse(value, path, "an array of shape (n, 3)");
  }
  if (nb::cast<std::size_t>(array.attr("size")) == 0) return;
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (kind != "i" && kind != "u") refuse(value, path, "whole numbers, indices of positions");
  for (const char* end : {"min", "max"}) {
    std::uint32_t index = 0;
    const nb::object number = array.attr(end)().attr("item")();
    if (nb::try_cast(number, index)) continue;
    throw nb::value_error(
        (path + ": " + nb::cast<std::string>(nb::str(number)) + " isn't the index of a position").c_str());
  }
}

template <typename T, typename Row>
nb::object writable_array(const std::vector<Row>& rows) {
  std::vector<T> flat(rows.size() * 3);
  std::memcpy(flat.data(), static_cast<const void*>(rows.data()), flat.size() * sizeof(T));
  return to_numpy(std::move(flat), {rows.size(), 3}).attr("copy")();  // to be changed by who gets it
}

}  // namespace

template <>
nb::object Special<TriMesh>::to(const TriMesh& mesh) {
  return spec_class("Mesh")(to_python(mesh.name), writable_array<double>(mesh.positions),
                            writable_array<std::uint32_t>(mesh.triangles), to_python(mesh.solidity),
                            to_python(mesh.temperature_c));
}
template <>
TriMesh Special<TriMesh>::from(nb::handle value, const std::string& path) {
  if (!nb::isinstance(value, spec_class("Mesh"))) refuse(value, path, "a pirsim.Mesh");
  require_indices(value.attr("triangles"), path + ".triangles");
  return {from_python<std::string>(value.attr("name"), path + ".name"),
          rows_of_three<double, Vec3>(value.attr("positions"), "float64", path + ".positions"),
          rows_of_three<std::uint32_t, std::array<std::uint32_t, 3>>(value.attr("triangles"), "uint32",
                                                                     path + ".triangles"),
          from_python<Solidity>(value.attr("solidity"), path + ".solidity"),
          from_python<std::optional<double>>(value.attr("temperature_c"), path + ".temperature_c")};
}

template <>
nb::object Special<MeshSolid>::to(const MeshSolid& solid) {
  return nb::cast(solid);
}
template <>
MeshSolid Special<MeshSolid>::from(nb::handle value, const std::string& path) {
  MeshSolid solid;
  if (!nb::try_cast(value, solid) || solid.surface == nullptr) refuse(value, path, "what read_script() gave");
  return solid;
}

template <>
nb::object Special<Issue>::to(const Issue& issue) {
  return spec_class("Diagnostic")(to_python(issue.severity), to_python(issue.where.file), issue.where.line,
                                  issue.where.column, to_python(issue.message));
}
template <>
Issue Special<Issue>::from(nb::handle value, const std::string& path) {
  if (!nb::isinstance(value, spec_class("Diagnostic"))) refuse(value, path, "a pirsim.Diagnostic");
  return {from_python<Severity>(value.attr("severity"), path),
          {from_python<std::string>(value.attr("file"), path), from_python<int>(value.attr("line"), path),
           from_python<int>(value.attr("column"), path)},
          from_python<std::string>(value.attr("text"), path)};
}

namespace {

/// Sets `action` if the value is of this alternative's class.
template <typename What>
bool take(nb::handle value, const std::string& path, Action& action) {
  if (!nb::isinstance(value, spec_class(Fields<What>::name))) return false;
  action = from_python<What>(value, path);
  return true;
}

template <typename... What>
bool take_any(nb::handle value, const std::string& path, std::variant<What...>& action) {
  return (take<What>(value, path, action) || ...);
}

}  // namespace

template <>
nb::object Special<ScriptedAction>::to(const ScriptedAction& action) {
  return std::visit(
      [&](const auto& what) -> nb::object {
        using What = std::remove_cvref_t<decltype(what)>;
        nb::dict fields;
        Convert<What>::add(what, fields);
        fields["at_s"] = to_python(action.at_s);
        fields["phase"] = to_python(action.phase);
        fields["where"] = to_python(action.where);
        return spec_class(Fields<What>::name)(**fields);
      },
      action.what);
}

template <>
ScriptedAction Special<ScriptedAction>::from(nb::handle value, const std::string& path) {
  ScriptedAction action;
  if (!take_any(value, path, action.what)) refuse(value, path, "an action, as pirsim.Walk");
  action.at_s = from_python<std::optional<double>>(value.attr("at_s"), path + ".at_s");
  action.phase = from_python<std::string>(value.attr("phase"), path + ".phase");
  action.where = from_python<Where>(value.attr("where"), path + ".where");
  return action;
}

namespace {

template <typename Spec>
Spec checked(nb::handle value, const char* path) {
  Spec spec = from_python<Spec>(value, path);
  Diagnostics diagnostics;
  check(spec, diagnostics);
  diagnostics.throw_if_errors();
  return spec;
}

}  // namespace

SceneSpec checked_scene(nb::handle scene) { return checked<SceneSpec>(scene, "scene"); }
ScriptSpec checked_script(nb::handle script) { return checked<ScriptSpec>(script, "script"); }

}  // namespace pirsim::python
