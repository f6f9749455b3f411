// The report page of a wheel: verdict and numbers of all passages, quality and pictures of the worst one.
#pragma once

#include <gridmorph/run/run_page.hpp>
#include <gridmorph/run/wheel_run.hpp>

namespace gridmorph::cli {

/// Pictures and numbers of the worst passage. worst: where a run with keep_worst() has it, at the worst step. The
/// console is told, and `document` the time that it took. Cost: as RunPage::finish().
void draw_wheel_page(WheelRun const& run, CaseFile const& case_file, Coordinates const& worst, RunDocument& document,
                     RunPage& page, Console& console);

}  // namespace gridmorph::cli
