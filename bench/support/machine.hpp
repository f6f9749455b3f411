// What a reader of the figures has to know about the machine and the build.
#pragma once

namespace gridmorph::bench {

/// Adds it to the context of the report.
void add_machine_context();

}  // namespace gridmorph::bench
