"""Grasshopper's own components by their id: what a definition may hold beside parameters and scripts.

Each line is an id, then the name that Grasshopper writes beside it; further names after `|` are those of other
versions. Source: a public listing of what an installed Rhino 7/8 offers (github.com/hellguz/ScriptBridgeJS,
gh_docs_generation/grasshopper_components.md); the sample of github.com/mcneel/compute.rhino3d agrees with it.
"""

CURVE = """
84627490-0fb2-4498-8138-ad134ee4cb36 Curve | Curve
ccc7b468-e743-4049-891f-299432545898 Curve Middle
424eb433-2b3a-4859-beaf-804d8af0afd7 Control Points
ccfd6ba8-ecb1-44df-a47e-08126a653c51 Curve Domain
323f3245-af49-4489-8677-7a2c73664077 Closed
11bbd48b-bb0a-4f1b-8167-fa297590390d End Points
fc6979e4-7e91-4508-8e05-37c680779751 Evaluate Curve
6b021f56-b194-4210-b9a1-6cef3b7d0848 Evaluate Length
c75b62fa-0a33-4da7-a5bd-03fd0068fd93 Length
f88a6cd9-1035-4361-b896-4f2dfe79272d Segment Lengths
59e94548-cefd-4774-b3de-48142fc783fb Polygon Center
6b7ba278-5c9d-42f1-a61d-6209cbd44907 Curve Proximity
269eaa85-9997-4d77-a9ba-4c58cb45c9d3 Discontinuity
69f3e5ee-4770-44b3-8851-ae10ae555398 Perp Frame
a72b0bd3-c7a7-458e-875d-09ae1624638c Point In Curve
0e94542a-2e46-4793-9f98-2200b06b28f4 Curve Frames
2162e72e-72fc-4bf8-9459-d4d82fa8aa14 Divide Curve
1e531c08-9c80-46d6-8850-1b50d1dae69f Divide Distance
fdc466a9-d3b8-4056-852a-09dba0f74aca Divide Length
6e9c0577-ae4a-4b21-8880-0ec3daf3eb4d Divide By Deviation
983c7600-980c-44da-bc53-c804067f667f Perp Frames
2ad2a4d4-3de1-42f6-a4b8-f71835f35710 Shatter
bb59bffc-f54c-4682-9778-f6c3fe74fce3 Arc
9fa1b081-b1c7-4a12-a163-0aa8da9ff6c4 Arc 3Pt
9d2583dd-6cf5-497c-8c40-c9a290598396 Arc SED
807b86e3-be8d-4970-92b5-f8cdcb45b06b Circle
47886835-e3ff-4516-a3ed-1b419f055464 Circle 3Pt
d114323a-e6ee-4164-946b-e4ca0ce15efa Circle CNR
46b5564d-d3eb-4bf1-ae16-15ed132cfd88 Ellipse
4c4e56eb-2f04-43f9-95a3-cc46a14f495a Line
4c619bc9-39fd-4717-82a6-1e07ea237bbe Line SDL
845527a6-5cea-4ae9-a667-96ae1667a4e8 Polygon
d93100b6-d50b-40b2-831a-814659dc38e3 Rectangle
575660b1-8c79-4b8d-9222-7ab4a6ddb359 Rectangle 2Pt
9bc98a1d-2ecc-407e-948a-09a09ed3e69d Rectangle 3Pt
30ce59ce-22a1-49ee-9e21-e6d16b3684a8 Bezier Span
275671d4-3e87-40bd-8aff-8e6a5fdbb892 Catenary
769f9064-17f5-4c4a-921f-c3a0ee05ba3a Catenary Ex
2b2a4145-3dff-41d4-a8de-1ea9d29eef33 Interpolate
75eb156d-d023-42f9-a85e-2f2456b8bcce Interpolate (t)
d1d57181-d594-41e8-8efb-041e29f8a5ca Iso Curve
dde71aef-d6ed-40a6-af98-6b0673983c82 Nurbs Curve
71b5b089-500a-4ea6-81c5-2f960441a0e8 PolyLine
429cbba9-55ee-4e84-98ea-876c44db879a Sub Curve
f73498c5-178b-4e09-ad61-73d172fa6e56 Tangent Curve
2956d989-3599-476f-bc92-1d847aff98b6 Curve To Polyline
afb96615-c59a-45c9-9cac-e27acb1c7ca0 Explode
62cc9684-6a39-422e-aefa-ed44643557b9 Extend Curve
2f407944-81c3-4062-a485-276454ec4b8c Fillet
22990b1f-9be6-477c-ad89-f775cd347105 Flip Curve
8073a420-6bec-49e3-9b18-367f6fd76ac3 Join Curves
1a38d325-98de-455c-93f1-bca431bc1243 Offset Curve
d7ee52ff-89b8-4d1a-8662-3e0dd391d0af Project
9333c5b3-11f9-423c-bbb5-7e5156430219 Rebuild Curve
42ad8dc1-b0c0-40df-91f5-2c46e589e6c2 Seam
"""

DISPLAY = """
a45d68b3-c299-4b17-bdae-7975f216cec6 Colour HSL
5958a658-20c2-4a2b-86ba-4d1b81bf5348 Colour HSV
49d2e200-b34e-4e1c-82a3-07feb4cb9378 Colour RGB
3b220754-4114-4170-b6c3-b286b86ed524 Text Tag
5a41528b-12b9-40dc-a3f2-842034d267c4 Text Tag 3D
f6867cdd-2216-4451-9134-7da94bdcd5af Legend
76975309-75a6-446a-afed-f8653720a9f2 Create Material
537b0419-bbc2-4ff4-bf08-afe526367b2c Custom Preview
6b1bd8b2-47a4-4aa6-a471-3fd91c62a486 Dot Display
cc14daa5-911a-4fcc-8b3b-1149bf7f2eeb Point List
1f18e802-4ab9-444f-bf3c-3e7e421a2acf Point List
2a3f7078-2e25-4dd4-96f7-0efb491bd61c Vector Display
11e95a7b-1e2c-4b66-bd95-fcad51f8662a Vector Display Ex
8b4da37d-1124-436a-9de2-952e4224a220 Blend Colours
"""

MATHS = """
338666eb-14c5-4d9b-82e2-2b5be60655df Weighted Average
de4a0d86-2709-4564-935a-88bf4d40af89 Gate Xor
b6aedcac-bf43-42d4-899e-d763612f834d Gate Xnor
5ca5de6b-bc71-46c4-a8f7-7f30d7040acb Gate Nand
548177c2-d1db-4172-b667-bec979e2d38b Gate Nor
7e3185eb-a38c-4949-bcf2-0e80dee3a344 Cube
5b0be57a-31f5-4446-a11a-ae0d348bca90 Cube Root
27d6f724-a701-4585-992f-3897488abf08 Logarithm
23afc7aa-2d2f-4ae7-b876-bf366246b826 Natural logarithm
2ebb82ef-1f90-4ac9-9a71-1fe0f4ef7044 Power of 10
7a1e5fd7-b7da-4244-a261-f1da66614992 Power of 2
c717f26f-e4a0-475c-8e1c-b8f77af1bc99 Power of E
cc15ba56-fae7-4f05-b599-cb7c43b60e11 ArcSine
49584390-d541-41f7-b5f6-1f9515ac0f73 ArcCosine
b4647919-d041-419e-99f5-fa0dc0ddb8b6 ArcTangent
cb22d3ed-93d8-4629-bdf2-c0c7c25afd2c Golden Ratio
b6cac37c-21b9-46c6-bd0d-17ff67796578 Natural logarithm
e44c1bd7-72cc-4697-80c9-02787baf7bb4 Mass Multiplication
dd17d442-3776-40b3-ad5b-5e188b56bd4c Relative Differences
f44b92b0-3b5b-493a-86f4-fd7408c3daf3 Bounds
d1a28e95-cf96-4936-bf34-8bf142d731bf Construct Domain
8555a743-36c1-42b8-abcc-06d9cb94519f Construct Domain²
9083b87f-a98c-4e41-9591-077ae4220b19 Construct Domain²
825ea536-aebb-41e9-af32-8baeb2ecb590 Deconstruct Domain
75ef4190-91a2-42d9-a245-32a7162b0384 Divide Domain
75ac008b-1bc2-4edd-b967-667d628b9d24 Divide Domain²
f217f873-92f1-47ae-ad71-ca3c5a45c3f8 Includes
2fcc2743-8339-4cdf-a046-a1f17439191d Remap Numbers
28124995-cf99-4298-b6f4-c75a8e379f18 Absolute
a0d62394-a118-422d-abb3-6af115c75b25 Addition
9c85271f-89fa-4e9f-9f4a-d75802120ccc Division
5db0fb89-4f22-4f09-a777-fa5e55aed7ec Equality
040f195d-0b4e-4fe0-901f-fedb2fd3db15 Gate And
cb2c7d3c-41b4-4c6d-a6bd-9235bd2851bb Gate Not
5cad70f9-5a53-4c5c-a782-54a479b4abe3 Gate Or
54db2568-3441-4ae2-bcef-92c4cc608e11 Integer Division
30d58600-1aab-42db-80a3-f1ea6c4269a0 Larger Than
5b850221-b527-4bd6-8c62-e94168cd6efa Mass Addition
431bc610-8ae1-4090-b217-1a9d9c519fe2 Modulus
ce46b74e-00c9-43c4-805a-193b69ea4a11 Multiplication
b8963bb1-aa57-476e-a20e-ed6cf635a49c Multiplication
a3371040-e552-4bc8-b0ff-10a840258e88 Negative
78fed580-851b-46fe-af2f-6519a9d378e0 Power
40177d8a-a35c-4622-bca7-d150031fe427 Similarity
ae840986-cade-4e5a-96b0-570f007d4fc0 Smaller Than
9c007a04-d0d9-48e4-9da3-9ba142bc4d46 Subtraction
797d922f-3a1d-46fe-9155-358b009b5997 One Over X
2280dde4-9fa2-4b4a-ae2f-37d554861367 Square
ad476cb7-b6d1-41c8-986b-0df243a64146 Square Root
cc2b626f-6eff-4d08-9829-2877560693f4 Evaluate
9df5e896-552d-4c8c-b9ca-4fc147ffa022 Expression
d2d2a900-780c-4d58-9a35-1f9d8d35df6f Cosine
7663efbb-d9b8-4c6a-a0da-c3750a7bbe77 Sine
0f31784f-7177-4104-8500-1f4f4a306df4 Tangent
0d77c51e-584f-44e8-aed2-c2ddf4803888 Degrees
a4cd2751-414d-42ec-8916-476ebf62d7fe Radians
7986486c-621a-48fb-8f27-a28a22c91cc9 Average
0d1e2027-f153-460d-84c0-f9af431b08cb Maximum
57308b30-772d-4919-ac67-e86c18f3a996 Minimum
0d2ccfb3-9d41-4759-9452-da6a522c3eaa Pi
a50c4a3b-0177-4c91-8556-db95de6c56c8 Round
"""

MESH = """
01e3991d-18bd-474f-9fbd-076a8700159f Mesh Inclusion
47814a17-ca9e-4305-9400-3a9c8d71c19d Unweld Mesh
d0f1311b-8287-4484-b2ea-1475c6770926 Delete Faces
4dce5963-dc1a-4710-8991-9437ea23888d Disjoint Mesh
aab142b1-b870-46de-8e86-654c9a554d90 Deconstruct Face
ba2d8f57-0738-42b4-b5a5-fe4d853517eb Deconstruct Mesh
0b4ac802-fc4a-4201-9c66-0078b837c1eb Face Boundaries
cb4ca22c-3419-4962-a078-ad4ff7f1f929 Face Normals
a559fee2-4b76-4370-8042-c7440cd75049 Mesh Closest Point
2b9bf01d-5fe5-464c-b0b3-b469eb5f2efb Mesh Edges
e2c0f9db-a862-4bd9-810c-ef2610e7a56f Construct Mesh
d2cedf38-1149-4adc-8dbf-b06571cb5106 Mesh Colours
8adbf481-7589-4a40-b490-006531ea001d Mesh Plane
1cb59c86-7f6b-4e52-9a0c-6441850e9520 Mesh Quad
0a391eac-5048-443c-9c1b-f592299b6dd6 Mesh Sphere
5a4ddedd-5af9-49e5-bace-12910a8b9366 Mesh Triangle
2696bd14-3fb5-4750-827f-86df6c31d664 Mesh Box
db2a4d25-23fa-4887-8983-ee5293cc82c0 Delaunay Edges
1eb4f6ff-3547-4184-bead-1b01e7cfd668 Delaunay Mesh
866222ee-6093-4af8-8944-2f9264885385 TriRemesh
a4011be0-1c91-45bd-8280-17dd3a9f46f1 Voronoi
57edd208-760a-4f0f-87e6-ca1bbd74133b Cull Faces
47fbc929-e88a-4a13-882e-dad84763256d Flip Mesh
60e7defa-8b21-4ee1-99aa-a9223d6134ff Mesh Brep
4bc9dbbf-fec8-4348-a3af-e33e7edc8e7b Mesh Join
58cf422f-19f7-42f7-9619-fc198c51c657 Mesh Surface
4a0180e5-d8f9-46e7-bd34-ced804601462 Settings (Custom)
1b0ee096-cc76-4847-8941-04a9e256de76 Settings (Quality)
255ca3e9-2c1e-443a-a404-e76b5c63f4cb Settings (Speed)
c3f9cea5-6fd4-4db5-959b-08cd08ed9fe1 Simple Mesh
e45aa4a0-e40d-421c-a335-5185dd131836 Smooth Mesh
3fba11d5-b30a-4146-8d80-d591e7a0a287 Triangulate
ca6a48f4-b681-4989-b0c1-301a2929a84c Unify Mesh
9f6d85c9-1143-4538-bca7-69dcb11a74ef Weld Mesh
"""

SETS = """
f02a20f6-bb49-4e3d-b155-8ed5d3c6b000 Jitter
fe99f302-3d0d-4389-8494-bd53f7935a02 Fibonacci
fe769f85-8900-45dd-ba11-ec9cd6c778c6 Prune Tree
df6d9197-9a6e-41a2-9c9d-d2221accb49e Deconstruct Path
c74efd0e-7fe3-4c2d-8c9d-295c5672fb13 Null Item
f3230ecb-3631-4d6f-86f2-ef4b2ed37f45 Replace Nulls
5a13ec19-e4e9-43da-bf65-f93025fa87ca Shortest List
e7c80ff6-0299-4303-be36-3080977c14a1 Combine Data
36947590-f0cb-4807-a8f9-9c90c9b20621 Cross Reference
d8332545-21b2-4716-96e3-8559a9876e17 Dispatch
e2039b07-d3f3-40f8-af88-d74fed238727 Insert Items
a759fd55-e6be-4673-8365-c28d5b52c6c0 Item Index
59daf374-bc21-4a5e-8282-5504fb7ae9ae List Item
1817fd29-20ae-4503-b542-f0fb651e67d7 List Length
8440fd1b-b6e0-4bdb-aa93-4ec295c213e9 Longest List
5a93246d-2595-4c28-bc2d-90657634f92a Partition List
03b801eb-87cd-476a-a591-257fe5d5bf0f Pick'n'Choose
7a218bfb-b93d-4c1f-83d3-5a0b909dd60b Replace Items
6ec97ea8-c559-47a2-8d0f-ce80c794d1f4 Reverse List
4fdfe351-6c07-47ce-9fb9-be027fb62186 Shift List
3249222f-f536-467a-89f4-f0353fba455a Sift Pattern
6f93d366-919f-4dda-a35e-ba03dd62799b Sort List
9ab93e1a-ebdf-4090-9296-b000cff7b202 Split List
b333ff42-93bd-406b-8e17-15780719b6ec Sub List
50faccbd-9c92-4175-a5fa-d65e36013db6 Weave
501aecbb-c191-4d13-83d6-7ee32445ac50 Cull Index
932b9817-fcc6-4ac3-b5fd-c0e8eeadc53f Cull Nth
008e9a6f-478a-4813-8c8a-546273bc3a6b Cull Pattern
dd8134c0-109b-4012-92be-51d843edfff7 Duplicate Data
2ab17f9a-d852-4405-80e1-938c5e57e78d Random
455925fd-23ff-4e57-a0e7-913a4165e659 Random Reduce
9445ca40-cc73-4861-a455-146308676855 Range
c40dc145-9e36-4a69-ac1a-6d825c654993 Repeat Data
e64c5fb1-845c-4ab1-8911-5f338516ba67 Series
5fa4e736-0d82-4af0-97fb-30a79f4cbf41 Stack Data
98c3c63a-e78a-43ea-a111-514fcf312c95 Create Set
3ff27857-b988-417a-b495-b24c733dbd00 Member Index
e3b1a10c-4d49-4140-b8e6-0b5732a26c31 Set Difference
8eed5d78-7810-4ba1-968e-8a1f1db98e39 Set Union
2013e425-8713-42e2-a661-b57e78840337 Concatenate
758d91a0-4aec-47f8-9671-16739a8a2c5d Format
1274d51a-81e6-4ccf-ad1f-0edf4c769cac Text Join
04887d01-504c-480e-b2a2-01ea19cc5922 Text Split
071c3940-a12d-4b77-bb23-42b5d3314a0d Clean Tree
7991bc5f-8a01-4768-bfb0-a39357ac6b84 Clean Tree
946cb61e-18d2-45e3-8840-67b0efa26528 Construct Path
c9785b8e-2f30-4f90-8ee3-cca710f82402 Entwine
74cad441-2264-45fe-a57d-85034751208a Explode Tree
f80cfe18-9510-4b89-8301-8e58faf423bb Flatten Tree
41aa4112-9c9b-42f4-847e-503b9d90e4c7 Flip Matrix
87e1d9ef-088b-4d30-9dda-8a7448a17329 Graft Tree
3cadddef-1e2b-4c09-9390-0e8f78f7609f Merge
86866576-6cc0-485a-9cd2-6f7d493f57f7 Merge
481f0339-1299-43ba-b15c-c07891a8f822 Merge 03
b5be5d1f-717f-493c-b958-816957f271fd Merge 04
f4b0f7b4-5a10-46c4-8191-58d7d66ffdff Merge 05
ac9b4faf-c9d5-4f6a-a5e9-58c0c2cac116 Merge 06
a70aa477-0109-4e75-ba73-78725dca0274 Merge 08
22f66ff6-d281-453c-bd8c-36ed24026783 Merge 10
0b6c5dac-6c93-4158-b8d1-ca3187d45f25 Merge Multiple
bfaaf799-77dc-4f31-9ad8-2f7d1a80aeb0 Replace Paths
2d61f4e0-47c5-41d6-a41d-6afa96ee63af Shift Paths
1303da7b-e339-4e65-a051-82c4dce8224d Simplify Tree
eeafc956-268e-461d-8e73-ee05c6f72c01 Stream Filter
71fcc052-6add-4d70-8d97-cfb37ea9d169 Stream Gate
3a710c1e-1809-4e19-8c15-82adce31cd62 Tree Branch
c1ec65a3-bda4-4fad-87d0-edf86ed9d81c Tree Item
99bee19d-588c-41a0-b9b9-1d00fb03ea1a Tree Statistics
1177d6ee-3993-4226-9558-52b7fd63e1e3 Trim Tree
b8e2aa8f-8830-4ee1-bb59-613ea279c281 Unflatten Tree
"""

SURFACE = """
a10e8cdf-7c7a-4aac-aa70-ddb7010ab231 Box Corners
e03561f8-0e66-41d3-afde-62049f152443 Point In Brep
5106bafc-d5d4-4983-83e7-7be3ed07f502 Divide Surface
2e205f24-9279-47b2-b414-d06dcd0b21a7 Area
0148a65d-6f42-414a-9db7-9a9b2eb78437 Brep Edges
4beead95-8aa2-4613-8bb9-24758a0f5c4c Brep Closest Point
8d372bdc-9800-45e9-8a26-6e33c5253e21 Deconstruct Brep
353b206e-bde5-4f02-a913-b3b8a977d4b9 Evaluate Surface
4a9e9a8e-0943-4438-b360-129c30f2bb0f Surface Closest Point
15128198-399d-4d6c-9586-1f65db3ce7bf Surface Points
224f7648-5956-4b26-80d9-8d771f3dfd5d Volume
c77a8b3b-c569-4d81-9b59-1c27299a1c45 4Point Surface
d51e9b65-aa4e-4fd6-976c-cef35d421d05 Boundary Surfaces
36132830-e2ef-4476-8ea1-6a43922344f0 Edge Surface
962034e9-cc27-4394-afc4-5c16e3447cf9 Extrude
a7a41d0a-2188-4f7a-82cc-1a2c4e4ec850 Loft
45f19d16-1c9f-4b0f-a9a6-45a77f3d206c Loft Options
71506fa8-9bf0-432d-b897-b2e0c5ac316c Network Surface
57b2184c-8931-4e70-9220-612ec5b3809a Patch
c277f778-6fdf-4890-8f78-347efb23c406 Pipe
888f9c3c-f1e1-4344-94b0-5ee6a45aee11 Pipe Variable
cdee962f-4202-456b-a1b4-f3ed9aa0dc29 Revolution
6e5de495-ba76-42d0-9985-a5c265e9aeca Ruled Surface
5e33c760-adcd-4235-b1dd-05cf72eb7a38 Sum Surface
4b04a1e1-cddf-405d-a7db-335aaa940541 Surface From Points
bb6666e7-d0f4-41ec-a257-df2371619f13 Sweep1
75164624-395a-4d24-b60b-6bf91cab0194 Sweep2
0bb3d234-9097-45db-9998-621639c87d3b Bounding Box
2a43ef96-8f87-4892-8b94-237a47e8d3cf Box 2Pt
28061aae-04fb-4cb5-ac45-16f3b66bc0a4 Center Box
0373008a-80ee-45be-887d-ab5a244afc29 Cylinder
439a55a5-2f9e-4f66-9de2-32f24fec2ef5 Plane Surface
dabc854d-f50e-408a-b001-d043c7de151d Sphere
6a9ccaab-1b03-484e-bbda-be9c81584a66 Isotrim
332378f4-acb2-43fe-8593-ed22bfeb2721 Surface Frames
fa92858a-a180-4545-ad4d-0dc644b3a2a8 Untrim
"""

TRANSFORM = """
4f65c681-9331-4818-9d54-6290cae686c3 Surface Box
d8940ff0-dd4a-4e74-9361-54df537b50db Box Morph
5889b68f-fd88-4032-860f-869fb69654dd Surface Morph
4fe87ef8-49e4-4605-9859-87940d62e1de Move To Plane
5edaea74-32cb-4586-bd72-66694eb73160 Rotate Direction
1602b2cc-007c-4b79-8926-0067c6184e44 Orient Direction
23285717-156c-468f-a691-b242488c06a6 Project
4d2a06bd-4b0f-4c65-9ee0-4220e4c01703 Scale
290f418a-65ee-406a-a9d0-35699815b512 Scale NU
e87db220-a0a0-4d67-a405-f97fd14b2d7a Linear Array
fca5ad7e-ecac-401d-a357-edda0a251cbc Polar Array
e521f7c8-92f4-481c-888b-eea109e3d6e9 Rectangular Array
f12daa2f-4fd5-48c1-8ac3-5dea476912ca Mirror
e9eb1dcf-92f6-4d4d-84ae-96222d60f56b Move
378d0690-9da0-4dd1-ab16-1d15246e7c22 Orient
b7798b74-037e-4f0c-8ac7-dc1043d093e0 Rotate
3dfb9a77-6e05-4016-9f20-94f78607d672 Rotate 3D
3ac8e589-37f5-477d-aa61-6699702c5728 Rotate Axis
610e689b-5adc-47b3-af8f-e3a32b7ea341 Transform
874eebe7-835b-4f4f-9811-97e031c41597 Group
"""

VECTOR = """
0ae07da9-951b-4b9b-98ca-d312c252374d Numbers to Points
d24169cc-9922-4923-92bc-b9222efc413f Points to Numbers
75eec078-a905-47a1-b0d2-0934182b1e3d Plane Origin
f6f14b09-6497-4564-8403-09e4eb5a6b82 Rotate Plane
33bfc73c-19b2-480b-81e6-f3523a012ea6 Plane Fit
125dc122-8544-4617-945e-bb9a0c101c50 Hexagonal
e2d958e8-9f08-44f7-bf47-a684882d0b2a Populate 2D
e202025b-dc8e-4c51-ae19-4415b172886f Populate 3D
c8cb6a5c-2ffd-4095-ba2a-5c35015e09e4 Populate Geometry
66eedc35-187d-4dab-b49b-408491b1255f Radial
1a25aae0-0b56-497a-85b2-cc5bf7e4b96b Rectangular
717a1e25-a075-4530-bc80-d43ecc2500d9 Square
86a9944b-dea5-4126-9433-9e95ff07927a Triangular
bc3e379e-7206-4e7b-b63a-ff61f4b38a3e Construct Plane
3cd2949b-4ea8-4ffb-a70c-5c380f9f46ea Deconstruct Plane
c98a6015-7a2f-423c-bc66-bdc505249b45 Plane 3Pt
cfb6b17f-ca82-4f5d-b604-d4f69f569de3 Plane Normal
3a0c7bda-3d22-4588-8bab-03f57a52a6ea Plane Offset
17b7152b-d30d-4d50-b9ef-c9fe25576fc2 XY Plane
8cc3a196-f6a0-49ea-9ed9-0cb343a3ae64 XZ Plane
fad344bc-09b1-4855-a2e6-437ef5715fe3 YZ Plane
571ca323-6e55-425a-bf9e-ee103c7ba4b9 Closest Point
446014c4-c11c-45a7-8839-c45dc60950d6 Closest Points
3581f42a-9592-4549-bd6b-1c0fc39d067b Construct Point
6eaffbb2-3392-441a-8556-2dc126aa8910 Cull Duplicates
9abae6b7-fa1d-448c-9209-4a8155345841 Deconstruct
93b8e93d-f932-402c-b435-84be04d87666 Distance
5184b8cb-b71e-4def-a590-cd2c9bc58906 Project Point
902289da-28dc-454b-98d4-b8f8aa234516 Pull Point
4e86ba36-05e2-4cc0-a0f5-3ad57c91f04e Sort Points
fb012ef9-4734-4049-84a0-b92b85bb09da Addition
6ec39468-dae7-4ffa-a766-f2ab22a2c62e Amplitude
b464fccb-50e7-41bd-9789-8438db9bea9f Angle
2a5cfb31-028a-4b34-b4e1-9b20ae15312e Cross Product
a50fcd4a-cf42-4c3f-8616-022761e6cc93 Deconstruct Vector
310e1065-d03a-4858-bcd1-809d39c042af Divide
43b9ea8f-f772-40f2-9880-011a9c3cbbb0 Dot Product
63fff845-7c61-4dfb-ba12-44d481b4bf0f Multiply
d5788074-d75d-4021-b1a3-0bf992928584 Reverse
b6d7ba20-cf74-4191-a756-2216a36e30a7 Rotate
d2da1306-259a-4994-85a4-672d8a4c7805 Unit Vector
79f9fbb3-8f1d-4d9a-88a9-f7961b1012cd Unit X
d3d195ea-2d59-4ffa-90b1-8b7ff3369f69 Unit Y
9103c240-a6a9-4223-9b42-dbd19bf38e2b Unit Z
934ede4a-924a-4973-bb05-0dc4b36fae75 Vector 2Pt
675e31bf-1775-48d7-bb8d-76b77786dd53 Vector Length
56b92eab-d121-43f7-94d3-6cd8f0ddead8 Vector XYZ
"""

ALL = CURVE + DISPLAY + MATHS + MESH + SETS + SURFACE + TRANSFORM + VECTOR
