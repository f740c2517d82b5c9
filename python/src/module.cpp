#include "bindings.hpp"
#include "pirsim/version.hpp"

NB_MODULE(_core, module) {
  using namespace pirsim::python;
  module.doc() = "The library behind pirsim: use the package pirsim.";
  module.attr("__version__") = pirsim::version().c_str();
  module.attr("git_revision") = pirsim::git_revision().c_str();
  add_errors(module);
  add_inputs(module);
  add_study(module);
  add_surveys(module);
  add_look(module);
  add_log(module);
  add_dataset(module);
  add_reconcile(module);
  add_counting(module);
  add_control(module);
}
