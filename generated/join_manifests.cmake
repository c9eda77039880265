# Joins the manifests of the tables of three dimensions, of the builders, with those for tests, and of mesh cells into one
# JSON array.
set(text "[\n")
set(separator "")
foreach(manifest manifest2 manifest3 manifest4 builder2_manifest builder3_manifest builder4_manifest builder5_manifest
        builder2_edges_manifest builder3_edges_manifest builder3_barycentric_manifest builder3_barycentric_edges_manifest
        builder4_edges_manifest builder5_edges_manifest cells_manifest)
  file(READ ${TABLES}/${manifest}.json part)
  string(APPEND text "${separator}${part}")
  set(separator ",\n")
endforeach()
file(WRITE ${OUT} "${text}]\n")
