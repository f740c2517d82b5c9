// The list of commands. Each is registered by a file of its own: its options, its examples, and what it does.
#pragma once

#include <array>

#include "app/options.hpp"

namespace pirsim::app {

void add_run_command(CLI::App& app);
void add_check_command(CLI::App& app);
void add_preview_command(CLI::App& app);
void add_room_command(CLI::App& app);
void add_dataset_command(CLI::App& app);
void add_calibrate_command(CLI::App& app);
void add_count_command(CLI::App& app);
void add_control_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_view_command(CLI::App& app);
void add_effects_command(CLI::App& app);
void add_data_command(CLI::App& app);
void add_coverage_command(CLI::App& app);
void add_walktest_command(CLI::App& app);
void add_placements_command(CLI::App& app);
void add_merge_command(CLI::App& app);
void add_reconcile_command(CLI::App& app);
void add_log_command(CLI::App& app);
void add_help_command(CLI::App& app);

/// In the order of the help.
inline constexpr std::array all_commands{
    add_run_command,        add_check_command,   add_preview_command,   add_export_command,   add_view_command,
    add_room_command,       add_dataset_command, add_effects_command,   add_coverage_command, add_walktest_command,
    add_placements_command, add_merge_command,   add_reconcile_command, add_log_command,      add_calibrate_command,
    add_count_command,      add_control_command, add_data_command,      add_help_command};

}  // namespace pirsim::app
