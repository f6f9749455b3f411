// A wheel at one time: its mesh, report and page.
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/wheel_page.hpp>
#include <gridmorph/run/wheel_run.hpp>

#include <fmt/format.h>

#include <optional>

namespace gridmorph::cli {

namespace {

class WheelOnce {
 public:
  WheelOnce(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed)
      : case_file_(case_file),
        output_(case_file.wheel->output),
        console_(console),
        page_(case_file.output_options.page ? std::make_optional<RunPage>(case_file, typed) : std::nullopt),
        run_(case_file, file, console) {
    if (page_) run_.keep_worst();
  }

  int operator()() {
    run_.prepare();
    writer_.emplace(output_.string(), run_.wheel().mesh);
    WheelMade const made = run_.make(
        0, [&](int zone, double const* x, double const* y, double const* z) { writer_->write_zone(zone, x, y, z); });
    document_ = run_.document(made);
    if (page_) draw_wheel_page(run_, case_file_, *made.worst, document_, *page_, console_);
    written_ = !any_inverted(made) || case_file_.guard.write_inverted;
    return end();
  }

 private:
  void write() {
    if (!written_) return;
    writer_->commit();
    if (page_) page_->add_output(output_);
  }

  int end() {
    return conclude(
        {.document = document_,
         .options = case_file_.output_options,
         .output = output_,
         .page = page_,
         .written = written_,
         .write = [&] { write(); },
         .wrote = fmt::format("\nwrote {}\n", output_.string()),
         .refusal = [&] { return wheel_refusal(run_, output_, "cells are inverted that were not in the baseline"); }},
        console_);
  }

  CaseFile const& case_file_;
  std::filesystem::path const& output_;
  Console& console_;
  std::optional<RunPage> page_;
  WheelRun run_;
  std::optional<MeshFileWriter> writer_;
  RunDocument document_;
  bool written_ = false;
};

}  // namespace

int wheel_once(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  // No "output": it is CGNS, whatever the sector is.
  check_run_files(inputs_of(case_file, file),
                  outputs_of({{"wheel", case_file.wheel->output}}, case_file.output_options));
  return WheelOnce(case_file, file, console, typed)();
}

}  // namespace gridmorph::cli
