"""What single steps show as they become ever shorter."""
