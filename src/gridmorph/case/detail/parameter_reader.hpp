// Reads [parameters] and [sweep] of a case file. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/table_reader.hpp>

namespace gridmorph::casefile {

/// Fills CaseFile::parameters, with these values in place of the file's. From here on expressions of the file know
/// their names. Notes values beyond their range, and names in `values` that the file does not have.
void read_parameters(TableReader& root, ParameterValues const& values, CaseFile& out);

/// Makes a [sequence] of the designs of [sweep], if the file has it.
void read_sweep(TableReader& root, CaseFile& out);
/// Once all is read: all designs have one plan, so notes what depends on parameters and is no motion.
void require_one_plan(Context& context, CaseFile const& file);

/// Designs of a Latin hypercube (M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21 (1979) 239): each range in
/// `count` equal parts, each part met by one design, at a random place in it. Same on every machine. Cost:
/// O(count) per parameter.
std::vector<std::vector<double>> latin_hypercube(std::vector<Parameter> const& parameters, int count,
                                                 std::uint64_t seed);

}  // namespace gridmorph::casefile
