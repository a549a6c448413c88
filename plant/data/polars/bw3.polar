# BW-3, thin cambered plate
# Source: UIUC Low-Speed Airfoil Tests, volumes 1 and 3, wind-tunnel measurements.
# Drag as measured where it was (about -2 to 12 deg); outside, where only lift was measured (upward
# sweep), drag is our continuation: 0.7 per radian below the first angle, and past the lift peak a run
# over 4 deg into lift x tan(alpha), the force normal to a separated plate.
section bw3

reynolds 59400
  -2.110   -0.0850   0.07470
  -0.450    0.1560   0.04630
   1.060    0.3860   0.03370
   2.690    0.6090   0.03240
   4.240    0.8720   0.02790
   5.780    1.0330   0.02300
   7.320    1.1410   0.02180
   8.770    1.2070   0.03250
  10.300    1.2890   0.04100
  11.830    1.3210   0.05480

reynolds 99400
  -2.160   -0.1660   0.06810
  -0.480    0.1230   0.04140
   1.180    0.4560   0.02820
   2.710    0.6990   0.02510
   4.260    0.8660   0.02030
   5.770    0.9930   0.01810
   7.300    1.1000   0.02140
   8.700    1.1830   0.02960
  10.350    1.2840   0.04230
  11.730    1.3410   0.05890

reynolds 198900
  -2.580   -0.0840   0.05750
  -0.850    0.2940   0.03170
   0.480    0.5300   0.01920
   2.240    0.7280   0.01590
   3.750    0.8820   0.01510
   5.390    1.0340   0.01490
   6.820    1.1290   0.02210
   8.410    1.2400   0.02910
   9.730    1.3170   0.03860
  11.340    1.3930   0.06890
