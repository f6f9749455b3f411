// The report page of a wheel: verdict and numbers of all passages, quality and pictures of the worst one.
#pragma once

#include <gridmorph/run/run_page.hpp>
#include <gridmorph/run/wheel_run.hpp>

namespace gridmorph::cli {

/// Pictures and numbers of the worst passage. result: of a run with keep_worst(), over time that of the worst step.
/// The console is told, and `result` the time that it took. Cost: as RunPage::finish().
void draw_wheel_page(WheelRun const& run, CaseFile const& case_file, WheelResult& result, RunPage& page,
                     Console& console);

/// What the page is made from. report: that of the wheel, with its output.
nlohmann::json wheel_page_json(CaseFile const& case_file, WheelResult const& result, nlohmann::json const& report);

}  // namespace gridmorph::cli
