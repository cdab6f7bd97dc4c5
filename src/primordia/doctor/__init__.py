"""What is installed here, and whether the promises hold here."""
