// The module, and the library's errors as exceptions of pirsim.errors.
#include <exception>
#include <pirsim/version.hpp>

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
}  // namespace pirsim::python

NB_MODULE(_core, module) {
  using namespace pirsim::python;
  module.doc() = "The library behind pirsim: use the package pirsim.";
  module.attr("__version__") = pirsim::version().c_str();
  module.attr("git_revision") = pirsim::git_revision().c_str();
  nb::register_exception_translator(translate);
  add_inputs(module);
  add_study(module);
  add_surveys(module);
  add_dataset(module);
  add_reconcile(module);
  add_logs(module);
}
