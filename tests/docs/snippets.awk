# The C++ blocks of Markdown pages as one source file, each in a function of its own. What a block takes for granted stands above it,
# in a comment that no reader sees, as the parameters of that function; Exec and Positions are a space and Views (n, 3) in it:
#
#   <!-- snippet: Mesh const& mesh, Motion const& motion -->
BEGIN {
  print "using Exec = Kokkos::DefaultHostExecutionSpace;"
  print "using Positions = Kokkos::View<double* [3], Exec::memory_space>;\n"
}
/^<!-- snippet:.* -->$/ {
  parameters = substr($0, 15, length($0) - 18)
  marked = 1
}
/^```/ && within {
  printf "%snamespace snippet_%d {\nusing namespace gridmorph;\nvoid run(%s) {\n%s}\n}  // namespace snippet_%d\n\n", includes, n, parameters, code, n
  within = 0
  marked = 0
  parameters = ""
  next
}
/^```cpp$/ {
  if (!marked) printf "#error \"%s:%d: say above the block what it takes for granted: <!-- snippet: parameters -->\"\n", FILENAME, FNR
  within = 1
  ++n
  includes = ""
  code = sprintf("#line %d \"%s\"\n", FNR + 1, FILENAME)
  next
}
within && /^#include/ {
  includes = includes $0 "\n"
  $0 = ""
}
within {
  code = code $0 "\n"
}
END {
  if (within || marked) {
    print "#error a block of " FILENAME " has no end, or a comment no block"
  }
  if (!n) print "#error no block found"
}
