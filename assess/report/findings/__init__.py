"""What a report says of motions, of the verification, and of where methods disagree."""
