"""What each paper's rules compute, draw and say; a paper is a folder."""
