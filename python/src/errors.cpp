#include <exception>

#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

void translate(const std::exception_ptr& pointer, void*) {
  try {
    std::rethrow_exception(pointer);
  } catch (const Error& error) {
    try {
      const nb::object exception = nb::module_::import_("pirsim.errors")
                                       .attr("_exception")(static_cast<int>(error.code()), to_python(error.issues()));
      PyErr_SetObject(exception.type().ptr(), exception.ptr());
    } catch (nb::python_error& other) {
      other.restore();
    }
  }
}

}  // namespace

void add_errors(nb::module_&) { nb::register_exception_translator(translate); }

}  // namespace pirsim::python
