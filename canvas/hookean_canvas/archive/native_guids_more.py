"""Further ids of Grasshopper's own components with their names, of a public listing of all components."""

from __future__ import annotations

MORE = """
9ce34996-d8c6-40d3-b442-1a7c8c093614 Adjust Plane
e76040ec-3b91-41e1-8e00-c74c23b89391 Align Plane
2318aee8-01fe-4ea8-9524-6966023fc622 Align Planes
db661dd7-63a4-44c6-91f2-6faab2471383 Align Vertices
9adffd61-f5d1-4e9e-9572-e8d9145730dc Barycentric
539f5564-4fc0-4fc1-a7d3-b802fa2ef072 Bend Deform
75f4b0fd-9721-47b1-99e7-9c098b342e67 BiArc
6283fb37-e273-4eb2-8d2a-e347881e3928 Blend Box
5909dbcb-4950-4ce4-9433-7cf9e62ee011 Blend Curve
14cf43b6-5eb9-460f-899c-bdece732213a Blend Curve Pt
48a9fa10-8d3c-4767-aca6-81232271f6e0 Blur Mesh
b57bf805-046a-4360-ad76-51aeddfe9720 Boundary Volume
9f6f954c-ba7b-4428-bf1e-1768cdff666c Box Array
8465bcce-9e0a-4cf4-bbda-1a7ce5681e10 Box Mapping
2d3b6ef3-5c26-4e2f-bcb3-8ffb9fb0f7c3 Box Slits
1addcc85-b04e-46e6-bd4a-6f6c93bf7efd Brep Join
904e4b56-484a-4814-b35f-aa4baf362117 Brep | Brep
20ef81e8-df15-4a0c-acf1-993a7607cafb Brep | Curve
ed0742f9-6647-4d95-9dfd-9ad17080ae9c Brep | Line
4fe828e8-fa95-4cc5-9a8c-c33856ecc783 Brep | Plane
407e35c6-7c40-4652-bd80-fde1eb7ec034 Camera Obscura
b648d933-ddea-4e75-834c-8f6f3793e311 Cap Holes
f6409a9c-3d2a-4b14-9f2c-e3c3f2cb72f8 Cap Holes Ex
deffaf1e-270a-4c15-a693-9216b68afd4a Carthesian Product
01640871-69ea-40ac-9380-4660d6d28bd2 Char Sequence
86503240-d884-43f9-9323-efe30488a6e1 Characters
be52336f-a2e1-43b1-b5f5-178ba489508a Circle Fit
50b204ef-d3de-41bb-a006-02fba2d3f709 Circle TanTan
dcaa922d-5491-4826-9a22-5adefa139f43 Circle TanTanTan
4439a51b-8d24-4924-b8e2-f77e7f8f5bec Clash
70905be1-e22f-4fa8-b9ae-e119d417904f Closed Edges
2168853c-acd8-4a63-9c9b-ecde9e239eae Collision Many|Many
bb6c6501-0500-4678-859b-b838348981d1 Collision One|Many
17af01a5-a846-4769-9478-de1df65a0afa Colour CMYK
f922ed44-6e4a-44a0-8b4b-4b4a46bdfe29 Colour L*ab
75a07554-8a2c-4d87-81b9-d854f498509d Colour LCH
ca80054a-cde0-4f69-a132-10502b24866d Compound
d0a1b843-873d-4d1d-965c-b5423b35f327 Connect Curves
3b112fb6-3eba-42d2-ba75-0f903c18faab Contour
88cff285-7f5e-41b3-96d5-9588ff9a52b1 Contour
3e7e4827-6edd-4e10-93ac-cc234414d2b9 Contour (ex)
246cda78-5e88-4087-ba09-ae082bbc4af8 Contour (ex)
66d2a68e-2f1d-43d2-a53b-c6a4d17e627b Control Polygon
8248da39-0729-4e04-8395-267b3259bc2f Convex Edges
9d0c5284-ea24-4f9f-a183-ef57fc48b5b8 Convex Hull
5d192b90-1ae3-4439-bbde-b05976fc4ac3 Copy Trim
047097d1-83bd-4f76-9994-dff721c24047 CreatePlankton
9d50bf9b-46bc-403a-9ec9-1052f51dd6b6 Cull Vertices
aaa665bd-fd6e-4ccb-8d2c-c5b33072125d Curvature
7376fe41-74ec-497e-b367-1ffe5072608b Curvature Graph
c6f23658-617f-4ac8-916d-d0d9e7241b25 Curve Array
2dc44b22-b1dd-460a-a704-6462d6e91096 Curve Closest Point
a583f722-240a-4fc9-aa1d-021720a4516a Curve Depth
6b2a5853-07aa-4329-ba84-0a5d46b51dbd Curve Frame
748f214a-bc64-4556-9da5-4fa59a30c5c7 Curve Nearest Object
ffe2dbed-9b5d-4f91-8fe3-10c8961ac2f8 Curve On Surface
bb2e13da-09ca-43fd-bef8-8d71f3653af9 Curve Side
0e3173b6-91c6-4845-a748-e45d4fdbc262 Curve | Line
b7c12ed1-b09a-4e15-996f-3fa9f3f16b1c Curve | Plane
0991ac99-6a0b-47a9-b07d-dd510ca57f0f Curve | Self
95866bbe-648e-4e2b-a97c-7d04679e94e0 Dash Pattern
d8033e3f-8387-4ffc-ab99-929218e8c740 Data Input
dcd23728-8e0e-4241-94b3-7cc3985031dd Data Output
23862862-049a-40be-b558-2418aacbd916 Deconstruct Arc
97c28a7c-5d5a-4b3d-a935-b8730e88749b DeconstructPlankton
e5c33a79-53d5-4f2b-9a97-d3d45c780edc Deconstuct Rectangle
190d042c-2270-4bc1-81c0-4f90c170c9c9 Delete Consecutive
23d715f7-4bc6-4e69-b76d-7c04ca2ebf5f Delete Vertices
ab14760f-87a6-462e-b481-4a2c26a9a0d7 Derivatives
81800098-1060-4e2b-80d4-17f835cc825f Disjoint
64ff9813-8fe8-4708-ac9f-61b825213e83 Edges from Directions
71e99dbb-2d79-4f02-a8a6-e87a09d54f47 Edges from Faces
ff187e6a-84bc-4bb9-a572-b39006a0576d Edges from Length
e4ff8101-73c9-4802-8c5d-704d8721b909 Edges from Linearity
73269f6a-9645-4638-8d5e-88064dd289bd Edges from Points
a7c9f738-f8bd-4f64-8e7f-33341183e493 Evaluate Field
a78e3fbc-d199-4bd9-8df0-fc4c2743eb31 Exposure
ebd6c758-19ae-4d74-aed7-b8a0392ff743 Extremes
190c0070-8cbf-4347-94c2-d84bbb488d55 Facet Dome
add6be3e-c57f-4740-96e4-5680abaa9169 Field Line
c92cdfc8-3df8-4c4e-abc1-ede092a0aa8a Fillet
6fb21315-a032-400e-a80f-248687f5507f Fillet Distance
4b87eb13-f87c-4ff1-ae0e-6c9f1f2aecbd Fillet Edge
b4d4235f-14ff-4d4e-a29a-b358dcd2baf4 Find similar member
a3f9f19e-3e6c-4ac7-97c3-946de32c3e8e Fit Curve
1f798a28-9de6-47b5-8201-cac57256b777 Fit Line
fe9db51e-1ac6-4298-b9dc-6acf3008c8f2 Fitness Landscape
c3d1f2b8-8596-4e8d-8861-c28ba8ffb4f4 Flip
c73e1ed0-82a2-40b0-b4df-8f10e445d60b Flip Plane
c3249da4-3f8e-4400-833e-e4e984d28657 Flow
ce5963b4-1cea-4f71-acd2-a3c28ab85662 Geodesic
c048ad76-ffcd-43b1-a007-4dd1b2373326 Horizontal Frame
8d058945-ce47-4e7c-82af-3269295d7890 Horizontal Frames
28b1c4d4-ab1c-4309-accd-1b7a954ed948 InCircle
679a9c6a-ab97-4c20-b02c-680f9a9a1a44 InEllipse
51f61166-7202-45aa-9126-3d83055b269e Inverse Transform
cab92254-1c79-4e5a-9972-0a4412b35c88 IsoVist
93d0dcbc-6207-4745-aaf7-fe57a880f959 IsoVist Ray
b90eaa92-6e38-4054-a915-afcf486224b3 Kaleidoscope
1edcc3cf-cf84-41d4-8204-561162cfe510 Key/Value Search
6f0993e8-5f2f-4fc0-bd73-b84bc240e78e Kinky Curve
846470bd-4918-4d00-9388-7e022b2cba73 Knot Vector
188edd02-14a9-4828-a521-34995b0d1e4a Length Domain
a1c16251-74f0-400f-9e7c-5e379d739963 Length Parameter
d788ad7f-6d68-4106-8b2f-9e55e6e107c0 Line + Line
ccc3f2ff-c9f6-45f8-aa30-8a924a9bda36 Line + Pt
510c4a63-b9bf-42e7-9d07-9d71290264da Line 2Plane
b9fde5fa-d654-4306-8ee1-6b69e6757604 Line 4Pt
8cc9eb88-26a7-4baa-a896-13e5fc12416a Line Charge
6d4b82a7-8c1d-4bec-af7b-ca321ba4beb1 Line | Line
75d0442c-1aa3-47cf-bd94-457b42c16e9f Line | Plane
134a849b-0ff4-4f36-bdd5-95e3996bae8b Maelstrom
fc5b7d12-7247-4de0-81bc-9b2c2f8f72f6 Map to Surface
282bf4eb-668a-4a2c-81af-2432ac863ddd Match Curve
3756c55f-95c3-442c-a027-6b3ab0455a94 Match Text
46372d0d-82dc-4acb-adc3-25d1fde04c4e Match Tree
d6b43673-55dd-4e2f-95c4-6c69a14513a6 Merge Faces
d9a6fbd2-2e9f-472e-8147-33bf0233a115 Merge Fields
15204c6d-bba8-403d-9e8f-6660ab8e0df5 Merge Group
4f3147f4-9fcd-4a7e-be0e-b1841caa5f97 Mesh Difference
b2dc090f-b022-4264-8889-87e22979336e Mesh Eval
95aef4f6-66fc-477e-b8f8-32395a837831 Mesh Intersection
c3dce3e8-c9cc-413c-a93f-732434282fdd Mesh Shadow
76f85ee4-5a88-4511-8ba7-30df07e50533 Mesh Sphere Ex
afbf2fe0-4965-48d2-8470-9e991540093b Mesh Split
330eb9c9-0098-4375-9078-e00a419d49fb Mesh Split Plane
edcf10e1-02a0-48a4-ae2d-70c50d903dc8 Mesh Spray
88060a82-0bf7-46bb-9af8-bdc860cf7e1d Mesh Union
19632848-4b95-4e5e-9e86-b79b47987a46 Mesh | Curve
21b6a605-9568-4bf8-acc1-631565d609d7 Mesh | Mesh
3b1ae469-0e9b-461d-8c30-fa5a7de8b7a9 Mesh | Plane
4c02a168-9aba-4f42-8951-2719f24d391f Mesh | Ray
dc934310-67eb-4d1d-8607-7cc62a501dd9 MetaBall
c48cf4d4-432c-41b6-b77a-77650479a31f MetaBall(t)
c4373505-a4cf-4992-8db1-fd6e6bb5850d MetaBall(t) Custom
9c9f8219-ae88-4d29-ba1b-3433ed713639 Mirror Curve
6ce1aa3c-626b-4db7-8b5b-bf74c78f8c5e Mirror Surface
9d8dec9c-3fd1-481c-9c3d-75ea5e15eb1a Modified Arc
dd9f597a-4db0-42b1-9cb2-5607ec97db09 Move Away From
931e6030-ccb3-4a7b-a89a-99dcce8770cd Multiple Curves
1f8e1ff7-8278-4421-b39d-350e71d85d37 Nurbs Curve PWK
1583bd7e-4ab7-4439-b922-d6f8cd63c399 Occlusion
a59a68ad-fdd6-41dd-88f0-d7a6fb8d2e16 OcTree
80e55fc2-933b-4bfb-a353-12358786dba8 Offset Curve Loose
c6fe61e7-25e2-4333-9172-f4e2a123fcfe Offset Loose 3D
b6f5cb51-f260-4c74-bf73-deb47de1bf91 Offset on Srf
e2c6cab3-91ea-4c01-900c-646642d3e436 Offset Polyline
b25c5762-f90e-4839-9fc5-74b74ab42b1e Offset Surface
e7e43403-f913-4d83-8aff-5b1c7a7f9fbc Offset Surface Loose
1d8b0e2c-e772-4fa9-b7f7-b158251b34b8 Path Compare
5816ec9c-f170-4c59-ac44-364401ff84cd Planar
b075c065-efda-4c9f-9cc9-288362b1b4b9 Plane Closest Point
5f127fa4-ca61-418e-bb2d-e3739d900f1f Plane Coordinates
80e3614a-25ae-43e7-bb0a-760e68ade864 Plane Region
290cf9c4-0711-4704-851e-4c99e3343ac5 Plane | Plane
f1ea5a4b-1a4f-4cf4-ad94-1ecfb9302b6e Plane | Plane | Plane
c9377989-c89e-477d-8dd2-b35af0c3b25d PlanktonFromPoints
a484c1c6-bb88-4507-b650-58aadebda4c1 PlanktonMesh
cffdbaf3-8d33-4b38-9cad-c264af9fc3f4 Point Charge
23603075-be64-4d86-9294-c3c125a12104 Point Cylindrical
4dbd15c7-ebcb-4af6-b3bd-32e80502520c Point Deform
81f6afc9-22d9-49f0-8579-1fd7e0df6fa6 Point Groups
0b04e8b9-00d7-47a7-95c3-0d51e654fe88 Point in Curves
aa333235-5922-424c-9002-1e0b866a854b Point Oriented
a435f5c8-28a2-43e8-a52a-0b6e73c2e300 Point Polar
7159ef59-e4ef-44b8-8cb2-91231e278292 PolyArc
f4568ce6-aade-4511-8f32-f27d8a6bf9e9 Polygon Edge
be298882-28c9-45b1-980d-7192a531c9a9 Polyline Collapse
06d7bc4a-ba3e-4445-8ab5-079613b52f28 Project Along
458ed0e0-19a3-419b-8ead-f524925b8a35 Proximity 2D
e504d619-4467-437a-92fa-c6822d16b066 Proximity 3D
6b5812f5-bb36-4d74-97fc-5a1f2f77452d Pull Curve
1a17d3f0-c8f8-4ee9-8dab-ea1c29db6a49 Quad Remesh
f562505b-4c49-49d1-932d-c8804b3fcec6 Quad Remesh Settings
9266a2bb-918f-4675-9c91-f67d0dd33eac Quadrangulate
8102032b-9699-4949-ab12-3017a31d1062 QuadTree
a12dddbf-bb49-4ef4-aeb8-5653bc882cbd RandomEx
17d40004-489e-42d9-ad10-857f7b436801 Rectangle Mapping
884646c3-0e70-4ad1-90c5-42601ee26450 Reduce
f72c480b-7ee6-42ef-9821-c371e9203b44 Region Difference
477c2e7b-c5e5-421e-b8b2-ba60cdf5398b Region Intersection
fac0d5be-e3ff-4bbb-9742-ec9a54900d41 Relative Item
2653b135-4df1-4a6b-820c-55e2ad3bc1e0 Relative Items
bafac914-ede4-4a59-a7b2-cc41bc3de961 Replace Members
4df8df00-3635-45bd-95e6-f9206296c110 Replace Text
a1da39b7-6387-4522-bf2b-2eaee6b14072 Retrim
03b3db66-d7e8-4d2d-bc0c-122913317254 Sanity XForm
e9b2d2a6-0377-4c1c-a89e-b3f219a95b4d Sequence
d2461702-3164-4894-8c10-ed1fc4b52965 Set Difference (S)
82f19c48-9e73-43a4-ae6c-3a8368099b08 Set Intersection
d4136a7b-7422-4660-9404-640474bd2725 Set Majority
5a27203a-e05f-4eea-b80f-a5f29a00fdf2 Shear
f19ee36c-f21f-4e25-be4c-4ca4b30eda0d Shear Angle
922dc7e5-0f0e-4c21-ae4b-f6a8654e63f6 Simplify Curve
5c5fbc42-3e1d-4081-9cf1-148d0b1d9610 Smooth Polyline
59e1f848-38d4-4cbf-ad7f-40ffc52acdf5 Solar Incidence
59aaebf8-6654-46b7-8386-89223c773978 Sort Along Curve
cec16c67-7b8b-41f7-a5a5-f675177e524b Sort Text
66e6596f-6c8f-4ac3-99e0-0c4b7a59a7f7 Spatial Deform
331b74f1-1f1f-4f37-b253-24fcdada29e3 Spatial Deform (custom)
4b59e893-d4ee-4e31-ae24-a489611d1088 Spin Force
915f8f93-f5d1-4a7b-aecb-c327bab88ffb Split
fd03419e-e1cc-4603-8a57-6dfa56ed5dec Split Group
d8b1e7ac-cd31-4748-b262-e07e53068afc Split Tree
4bdc2eb0-24ed-4c90-a27b-a32db069eaef Split with Brep
5b742537-9bcb-4f06-9613-866da5bf845e Split with Breps
ff4e6ccd-47ba-4c8c-8287-2a1f2cb1fa5e Splop
9cacad37-b09f-4b54-b2b1-1ccdc2e3ffea Sporph
2a27f87c-61c5-47c2-a0b7-7863f31a3594 Stretch
855a2c73-31c0-41d2-b061-57d54229d11b SubD from Mesh
4cfc0bb0-0745-4772-a520-39f9bf3d99bc SubSet
415750fd-c0ec-4411-84d0-01f28ab23066 Substrate
7db14002-c09c-4d7b-9f80-e4e2b00dfa1d Surface Split
68546dd0-aa82-471c-87e9-81cb16ac50ed Surface | Curve
a834e823-ae01-44d8-9066-c138eeb6f391 Surface | Line
3edc4fbd-24c6-43de-aaa8-5bdf0704373d Swing Arc
f1c0783b-60e9-42a7-8081-925bc755494c Tangent Arcs
ea0f0996-af7a-481d-8099-09c041e6c2d5 Tangent Lines
d6d68c93-d00f-4cd5-ba89-903c7f6be64c Tangent Lines (Ex)
e0168047-c46a-48c6-8595-2fb3d8574f23 Tangent Lines (In)
ad0ee51e-c86f-4668-8de5-b55b850f6001 Taper
b1991128-8bf1-4dea-8497-4b7188a64e9d Text Case
f7608c4d-836c-4adf-9d1f-3b04e6a2647d Text Distance
07e0811f-034a-4504-bca0-2d03b2c46217 Text Fragment
dca05f6f-e3d9-42e3-b3bb-eb20363fb335 Text Length
28504f1f-a8d9-40c8-b8aa-529413456258 Text On Surface
e4cb7168-5e32-4c54-b425-5a31c6fd685a Text Trim
61647ba2-31eb-4921-9632-df81e3286f7d To Polar
dbe9fce4-b6b3-465f-9615-34833c4763bd Torsion
61d81100-c4d3-462d-8b51-d951c0ae32db Triangle Mapping
3eba04bc-00e8-416d-b58f-a3dc8b3e22e2 Trim with Brep
916e7ebc-524c-47ce-8936-e50a09a7b43c Trim with Breps
3092caf0-7cf9-4885-bcc0-e635d878832a Trim with Region
26949c81-9b50-43b7-ac49-3203deb6eec7 Trim with Region
139619d2-8b18-47b6-b3b9-bf4fec0d6eb1 Tween Curve
9509cb30-d24f-4f55-a5ac-bf0b12a06cfa Twist
124de0f5-65f8-4ae0-8f61-8fb066e2ba02 Twisted Box
a45f59c8-11c1-4ea7-9e10-847061b80d75 Ungroup
d27cc1ea-9ef7-47bf-8ee2-c6662da0e3d9 Vector Force
ba9bb57a-61cf-4207-a1c4-994e371ba4f9 Voronoi 3D
7b181be1-30e7-4a97-915a-1b461741aef8 Voronoi Cell
9d4854fe-70db-4863-967b-4120d0b6d2e4 Voronoi Groups
"""
