#include "app/commands.hpp"
namespace pirsim::app { void preview(const Inputs&, const PreviewOptions&) {} }
