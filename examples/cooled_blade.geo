// A blade with a squealer tip, six holes and a stub of a part-span shroud on either side, in a box, for Gmsh: the mesh of cooled_blade.toml.
//   gmsh -3 cooled_blade.geo -o cooled_blade.msh
SetFactory("OpenCASCADE");
height = 1.5;
depth = 0.12; // of the recess in the tip
Cylinder(1) = {0, 0, 0, 0, 0, height, 0.5};
Dilate {{0, 0, 0}, {1, 0.28, 1}} { Volume{1}; }
Cylinder(2) = {0, 0, height - depth, 0, 0, 0.2, 0.4};
Dilate {{0, 0, 0}, {1, 0.2, 1}} { Volume{2}; }
Cylinder(3) = {0.1, -0.35, 0.75, 0, 0.7, 0, 0.07};
For k In {0:5}
  side = k % 2 == 0 ? 1 : -1;
  Cylinder(20 + k) = {-0.2, 0.07 * side, 0.3 + 0.45 * Floor(k / 2), 0, 0.3 * side, 0, 0.04};
EndFor
Box(10) = {-1.5, -1, 0, 3, 2, 1.8};
BooleanUnion(11) = { Volume{1}; Delete; }{ Volume{3}; Delete; };
BooleanDifference(12) = { Volume{11}; Delete; }{ Volume{2, 20:25}; Delete; };
BooleanDifference(13) = { Volume{10}; Delete; }{ Volume{12}; Delete; };

// Surfaces by where they lie; boxes around splines are larger than these.
e = 1e-3;
hub() = Surface In BoundingBox{-2, -2, -e, 2, 2, e};
sides() = Surface In BoundingBox{-2, -2, 1.8 - e, 2, 2, 1.8 + e};
For side In {-1:1:2}
  sides() += Surface In BoundingBox{1.5 * side - e, -2, -e, 1.5 * side + e, 2, 2};
  sides() += Surface In BoundingBox{-2, side - e, -e, 2, side + e, 2};
EndFor
squealer() = Surface In BoundingBox{-1, -0.4, height - depth - e, 1, 0.4, 1.7};
holes() = {};
For k In {0:2}
  holes() += Surface In BoundingBox{-0.25, -0.2, 0.25 + 0.45 * k, -0.15, 0.2, 0.35 + 0.45 * k};
EndFor
shroud() = Surface In BoundingBox{0, -0.4, 0.65, 0.2, 0.4, 0.85};
blade() = Surface{:};
blade() -= {hub(), sides(), squealer(), holes(), shroud()};
Physical Volume("fluid") = {Volume{:}};
Physical Surface("hub") = hub();
Physical Surface("sides") = sides();
Physical Surface("blade") = blade();
Physical Surface("squealer") = squealer();
Physical Surface("holes") = holes();
Physical Surface("shroud") = shroud();
MeshSize {PointsOf{Volume{:};}} = 0.3;
MeshSize {PointsOf{Surface{blade(), squealer()};}} = 0.08;
MeshSize {PointsOf{Surface{shroud()};}} = 0.05;
MeshSize {PointsOf{Surface{holes()};}} = 0.03;
