"""The museum's pictures and surface textures, and the programs that paint them."""
