# Writes a CTest test for each suite of a GoogleTest program: the tests of a suite share a process, and with it what
# they prepare once. A single test: --gtest_filter of the program.
#   cmake -DPROGRAM=<program> -DOUT=<file for CTest to include> -DSECONDS=<limit for a suite> -P list_suites.cmake
cmake_minimum_required(VERSION 3.24)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${listed}")
set(tests "")
foreach(suite IN LISTS suites)
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "\\.$" "" suite "${suite}")
  set(cost 1)
  set(labels "")
  # The longest ones first, so that none is left to run alone.
  if(suite MATCHES "^(ComparedRender|DatasetCommand|ExrStackTest|FlippedBits|NumberSweep|Reading|SimulatorFrame|StopsAnywhere)$")
    set(cost 100)
  elseif(suite MATCHES "^(CompareFit|CompareSpread|CompareSystole|CompareTilt|CompareViewRanking|CompareViews|DatasetGrowth|DatasetJoin|DicomViews|FitRegions|FittedRender|FitStrain|HeartFit|HeartMMode|HeartMotionWhole|KilledLoop|LeafletBodies|LeafletHearts|LooksLaw|PatientAgainstVideos|Planted|Privacy|SearchPrivacy|StudyCommandTest|StudySeeds|Tolerance|EachFamily/ToleranceOfHeart|Trabeculae|VideoWithEcg)$")
    set(cost 200)
    set(labels "LABELS long")  # searches, tables, hundreds of runs: minutes under sanitizers, over code that other suites run too
  elseif(suite MATCHES "^(BlockReach|ChordaeLaw|CoarseSurfacesLaw|CoherentEchoLaw|CompareEcg|DatasetPopulation|DatasetScenes|DecorrelationLaw|Doppler|DopplerHeart|DownshiftLaw|FibreDirection|FitChecksLaw|FitDesign|FitGrid|FitNewton|FitOwnLook|FitOwnSlope|FitPolish|FitResiduals|FitSections|GratingLobeLaw|HeartAnatomyLaw|HeartFolds|HeartFunctionLaw|HeartLoopLaw|HeartPatientLaw|HeartPrior|HeartTapseLaw|HeartViews|InteriorMotionLaw|LayerStack|LiveHeartDials|MaterialPointsLaw|MotionBetweenKeyframes|MotionChannelsLaw|NoiseLaw|ProbeView|SampledBeamLaw|SharedWindowsLaw|ShownTruthLaw|SmoothNormals|SpeckleLaw|StraightRays|SurroundingsLaw|TruthLabels|ValveRingLaw|ViewByHandLaw|ViewDensityLaw|ViewOffsetLaw|ViewPoseLaw|VisibleBorderLaw)$")
    set(cost 20)
    set(labels "LABELS long")  # numbers of closed forms and of many hearts: half a minute or more under sanitizers
  endif()
  string(APPEND tests "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                      "set_tests_properties([=[${suite}]=] PROPERTIES TIMEOUT ${SECONDS} COST ${cost} ${labels})\n")
endforeach()
file(WRITE ${OUT} "${tests}")
