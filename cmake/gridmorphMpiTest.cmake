# gridmorph_add_mpi_test(<name> <ranks> <command> ...): a test on so many ranks that mpirun starts on this machine.
#
# There may be more ranks than cores, and they may be root, as in containers; a rank that waits for ever, as the others do once a test
# has failed on one, is ended. What OpenMPI is told so others do not look at.
string(
  JOIN ";" gridmorph_mpi_environment
  OMP_NUM_THREADS=1 OMP_PROC_BIND=false KOKKOS_DISABLE_WARNINGS=1 MPIEXEC_TIMEOUT=50 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_pml=ob1
  OMPI_MCA_btl=self,vader OMPI_MCA_btl_vader_single_copy_mechanism=none)

function(gridmorph_add_mpi_test name n_ranks program)
  add_test(NAME ${name} COMMAND "${MPIEXEC_EXECUTABLE}" ${MPIEXEC_NUMPROC_FLAG} ${n_ranks} ${MPIEXEC_PREFLAGS} $<TARGET_FILE:${program}>
                                ${MPIEXEC_POSTFLAGS} ${ARGN})
  set_tests_properties(${name} PROPERTIES ENVIRONMENT "${gridmorph_mpi_environment}" PROCESSORS ${n_ranks} TIMEOUT 60)
endfunction()
