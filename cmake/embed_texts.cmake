# Writes the texts of a folder as rows of C++: {"name", R"trn(text)trn"},
#   cmake -DFOLDER=… -DOUT=… -P embed_texts.cmake
file(GLOB files ${FOLDER}/*.trn)
set(rows "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND rows "{\"${name}\", R\"trn(${text})trn\"},\n")
endforeach()
file(WRITE ${OUT} "${rows}")
